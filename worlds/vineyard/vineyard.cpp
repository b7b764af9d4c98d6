#include "worlds/vineyard/vineyard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "worlds/mapping/model/row_map.h"
#include "worlds/parts/alley_spawns.h"
#include "worlds/parts/leaf_area.h"
#include "worlds/parts/mesh_store.h"
#include "worlds/plants/planted_folder.h"
#include "worlds/vineyard/vineyard_params.h"

namespace vinerow::worlds {
namespace {

PartSpec vineyard_spec() {
  PartSpec spec;
  spec.name = "vineyard";
  spec.description =
      "parametric vine rows on terrain, loaded from mesh files; default: Parcel F of a Barolo "
      "vineyard "
      "(Biosystems Engineering 2022)";
  vineyard_table().add_to(spec);
  return spec;
}

/// Arcs about one centre that turn by `bend_rad` to the left; their middles stand across `along`
/// through `centre`, those to the left of it (offset > 0) on smaller radii where they turn left.
/// @throws ConfigError if the centre is within the block
mapping::RowCurve lay_arc(const Eigen::Vector2d& centre, const Eigen::Vector2d& along,
                          double offset_m, double length_m, double bend_rad) {
  constexpr double kStep_m = 1.0;
  const Eigen::Vector2d left(-along.y(), along.x());
  const double radius_m = length_m / bend_rad;  // signed: the arcs' centre lies to the left
  const double own_m = radius_m - offset_m;
  if (own_m / radius_m < 0.05) {
    throw ConfigError(
        fmt::format("row_bend_deg = {:.4g} deg bends rows of {:.4g} m about a centre {:.1f} m "
                    "beside the block's middle, and a row {:.1f} m beside it does not fit",
                    deg_from_rad(bend_rad), length_m, std::abs(radius_m), std::abs(offset_m)));
  }
  const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(own_m * bend_rad) / kStep_m)));
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k <= steps; ++k) {
    const double turn_rad = bend_rad * (static_cast<double>(k) / steps - 0.5);
    points.push_back(centre + radius_m * left +
                     own_m * (std::sin(turn_rad) * along - std::cos(turn_rad) * left));
  }
  return mapping::RowCurve(std::move(points));
}

std::vector<mapping::RowCurve> lay_rows(const VineyardParams& params) {
  // An arc whose middle lies no farther from its chord (length * bend / 8) is straight. The centre
  // of a flatter one is so far off that its points lose their digits.
  constexpr double kStraight_m = 1e-6;
  const Eigen::Vector2d along = bearing_direction(params.row_bearing_rad);
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Vector2d& centre = params.centre_W;
  const double length_m = params.row_length_m, half_m = 0.5 * length_m;
  std::vector<mapping::RowCurve> rows;
  for (int i = 0; i < params.row_count; ++i) {
    const double offset_m =
        (static_cast<double>(i) - 0.5 * static_cast<double>(params.row_count - 1)) * params.pitch_m;
    if (std::abs(params.row_bend_rad) * length_m / 8.0 > kStraight_m) {
      rows.push_back(lay_arc(centre, along, offset_m, length_m, params.row_bend_rad));
      continue;
    }
    const Eigen::Vector2d middle = centre + offset_m * across;
    rows.emplace_back(
        std::vector<Eigen::Vector2d>{middle - half_m * along, middle + half_m * along});
  }
  return rows;
}

double calc_relief_m(const TerrainSurface& surface, const std::vector<mapping::RowCurve>& rows) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const mapping::RowCurve& row : rows) {
    const int steps = std::max(1, static_cast<int>(row.length_m() / 2.0));
    for (int i = 0; i <= steps; ++i) {
      const double height = surface.height_m(row.point_W(row.length_m() * i / steps));
      low = std::min(low, height);
      high = std::max(high, height);
    }
  }
  return high - low;
}

/// Finds the slope that gives the required relief under the rows, of which waves alone may make up
/// at most half. @pre params.relief_m
TerrainShape fit_relief(const VineyardParams& params, const std::vector<mapping::RowCurve>& rows,
                        double* wave_height_m) {
  const double relief_m = *params.relief_m;
  const Eigen::Vector2d uphill = bearing_direction(params.uphill_bearing_rad);
  TerrainShape shape;
  shape.centre_W = params.centre_W;
  shape.wave_length_m = params.terrain.wave_length_m;
  shape.wave_height_m = params.terrain.waves_m;
  const auto relief_of = [&](const TerrainShape& s) {
    return calc_relief_m(TerrainSurface(s, terrain_random(params.planting.seed, "waves")), rows);
  };
  const double waves_relief_m = relief_of(shape);
  if (waves_relief_m > 0.5 * relief_m) shape.wave_height_m *= 0.5 * relief_m / waves_relief_m;
  *wave_height_m = shape.wave_height_m;
  // Bisection: the relief grows with the slope once the slope outweighs the waves.
  double low = 0.0, high = 1.0;
  const auto with_slope = [&](double slope) {
    TerrainShape s = shape;
    s.gradient = slope * uphill;
    return s;
  };
  while (relief_of(with_slope(high)) < relief_m && high < 1e6) high *= 2.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (relief_of(with_slope(middle)) < relief_m ? low : high) = middle;
  }
  return with_slope(relief_m > 0.0 ? high : 0.0);
}

Eigen::AlignedBox2d widened(const Eigen::AlignedBox2d& box, double by_m) {
  const Eigen::Vector2d margin(by_m, by_m);
  return {Eigen::Vector2d(box.min() - margin), Eigen::Vector2d(box.max() + margin)};
}

/// Lets the slope fade out beyond a box.
void limit_hillside(const Eigen::AlignedBox2d& box_W, double fade_m, TerrainShape& shape) {
  if (shape.gradient.isZero()) return;
  const Eigen::Vector2d uphill = shape.gradient.normalized();
  shape.hillside_from_m = std::numeric_limits<double>::infinity();
  shape.hillside_to_m = -shape.hillside_from_m;
  for (const auto corner : {Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::BottomRight,
                            Eigen::AlignedBox2d::TopLeft, Eigen::AlignedBox2d::TopRight}) {
    const double along_m = uphill.dot(box_W.corner(corner) - shape.centre_W);
    shape.hillside_from_m = std::min(shape.hillside_from_m, along_m);
    shape.hillside_to_m = std::max(shape.hillside_to_m, along_m);
  }
  shape.fade_m = fade_m;
}

HeightField make_ground(const VineyardParams& params, const std::vector<mapping::RowCurve>& rows,
                        const std::vector<Eigen::Vector2d>& boundary_W) {
  const Eigen::AlignedBox2d parcel = mapping::box_around(boundary_W);
  const Eigen::AlignedBox2d box = widened(parcel, params.surroundings_m);
  check_terrain_size(params.terrain, box);  // finding the slope takes its time, too
  TerrainShape shape;
  TerrainParams fitted = params.terrain;
  if (fitted.dem_file.empty()) {
    shape = fit_relief(params, rows, &fitted.waves_m);
    // The grid may reach one cell beyond its box.
    limit_hillside(widened(parcel, VineyardParams::kGroundMargin_m + fitted.cell_m),
                   params.slope_fade_m, shape);
  }
  return build_terrain(fitted, params.planting.seed, params.origin, shape, box);
}

/// The parameters with a relief: unless given, the ground is as steep as that of Parcel F.
VineyardParams read_vineyard(const ParameterSet& parameters) {
  constexpr double kRelief_m = 30.0, kRowLength_m = 118.0, kMax_m = 500.0;
  VineyardParams params = vineyard_table().read(parameters, "");
  if (!params.relief_m) {
    const double share = params.row_length_m / kRowLength_m;
    params.relief_m = std::min(kRelief_m * share, kMax_m);
  }
  return params;
}

std::unique_ptr<WorldModel> make_vineyard(const ParameterSet& parameters,
                                          const WorldContext& context) {
  const VineyardParams params = read_vineyard(parameters);
  const VinePlanting planting = settle_growth(params.planting);
  auto world = std::make_unique<WorldModel>();
  world->name = "vineyard";
  world->origin = params.origin;
  set_surroundings(params.surroundings, context.seed, *world);
  world->depends_on_seed = false;  // plants and terrain have a seed of their own

  const std::vector<mapping::RowCurve> rows = lay_rows(params);
  const std::vector<Eigen::Vector2d> boundary =
      mapping::parcel_boundary(rows, params.headland_m, params.pitch_m);
  world->terrain = make_ground(params, rows, boundary);
  const mapping::GroundHeight ground = ground_of(*world->terrain);
  world->rows = mapping::make_row_map(rows, ground, canopy_size(planting.canopy), boundary);
  add_alley_spawn_points(*world);
  if (params.neighbours) {
    world->scenery =
        make_neighbours(*params.neighbours, boundary, params.surroundings_m, planting.seed);
  }

  std::vector<VineRow> vine_rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double length_m = rows[i].length_m(), spacing_m = params.vine_spacing_m;
    const RandomStream random(planting.seed, "", fmt::format("world.missing.row_{}", i));
    VineRow row{rows[i],
                regular_vines(length_m, spacing_m, params.missing_vine_share, random),
                spacing_m,
                {}};
    if (planting.trellis.posts) {
      row.post_s_m = spread_posts(0.0, length_m, planting.trellis.post_spacing_m);
    }
    vine_rows.push_back(std::move(row));
  }
  FileMeshStore store(
      planted_folder(params.mesh_folder, "vineyard", parameters, vine_rows, *world->terrain));
  plant_vine_rows(*world, vine_rows, ground, planting, store);
  mapping::fill_occupancy(params.map, *world, place_obstacles(params.obstacles, *world),
                          row_end_margin_m(planting));
  settle_shelter(*world);
  return world;
}

}  // namespace

void register_vineyard(Registry& registry) {
  registry.add_world(vineyard_spec(), make_vineyard);
}

}  // namespace vinerow::worlds
