#include "worlds/vineyard/vineyard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "worlds/mapping/map_parameters.h"
#include "worlds/parts/common.h"
#include "worlds/parts/neighbours.h"
#include "worlds/parts/obstacles.h"
#include "worlds/parts/row_map.h"
#include "worlds/parts/terrain.h"
#include "worlds/parts/vine_rows.h"

namespace vinerow::worlds {
namespace {

/// Raised whenever generated meshes change for equal parameters: files of older programs are then
/// not read.
constexpr int kGeneratorVersion = 2;

/// The parcel and as much ground around it as is there by default keep the slope of the rows.
constexpr double kGroundMargin_m = 6.0;

PartSpec vineyard_spec() {
  PartSpec spec;
  spec.name = "vineyard";
  spec.description =
      "parametric vine rows on terrain, loaded from mesh files; default: Parcel F of a Barolo "
      "vineyard "
      "(Biosystems Engineering 2022)";
  spec.parameters = concatenate(
      {{integer_parameter("row_count", 16, 1, 1000, "number of rows"),
        positive_parameter("row_length_m", "m", 118, "length of each row"),
        positive_parameter("pitch_m", "m", 2.5, "distance between rows"),
        positive_parameter("vine_spacing_m", "m", 0.9, "between vines of a row"),
        number_parameter("missing_vine_share", "", 0.01, 0, 0.9, "share of vines that are missing"),
        number_parameter("row_bearing_deg", "deg", 80, -360, 360,
                         "direction of the rows, from north clockwise"),
        number_parameter("row_bend_deg", "deg", 0, -180, 180,
                         "by which the rows turn to the left from end to end, as arcs about one "
                         "centre; 0: straight"),
        number_parameter("headland_m", "m", 10, 8, 200, "free ground beyond the row ends"),
        // The middle of 44.6150 to 44.6157 deg north, 7.9244 to 7.9262 deg east, seen from the
        // corner.
        number_parameter("centre_x_m", "m", 71.4, -1e5, 1e5,
                         "east of the block's centre from the origin"),
        number_parameter("centre_y_m", "m", 38.9, -1e5, 1e5,
                         "north of the block's centre from the origin"),
        optional(number_parameter("relief_m", "m", 30, 0, 500,
                                  "highest minus lowest ground under the rows; default: 30 m for "
                                  "each 118 m of row length")),
        number_parameter("uphill_bearing_deg", "deg", 92, -360, 360,
                         "direction in which the ground rises, from north clockwise"),
        number_parameter("surroundings_m", "m", kGroundMargin_m, 0, 5000,
                         "ground beyond the parcel's box, for what flies over it"),
        positive_parameter("slope_fade_m", "m", 200,
                           "beyond the parcel the slope fades out over this way, to a ridge above "
                           "and a valley below"),
        path_parameter(
            "mesh_folder",
            "where mesh files are kept; default: $VINEROW_CACHE or the user's cache folder")},
       canopy_parameters(),
       trellis_parameters(),
       planting_parameters(),
       terrain_parameters(1.5),
       origin_parameters(44.6150, 7.9244, 300),
       surroundings_parameters(),
       neighbours_parameters(),
       map_parameters(),
       obstacle_parameters()});
  return spec;
}

/// Arcs about one centre that turn by `bend_rad` to the left; their middles stand across `along`
/// through `centre`, those to the left of it (offset > 0) on smaller radii where they turn left.
/// @throws ConfigError where the centre lies within the block
RowCurve lay_arc(const Eigen::Vector2d& centre, const Eigen::Vector2d& along, double offset_m,
                 double length_m, double bend_rad) {
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
  return RowCurve(std::move(points));
}

std::vector<RowCurve> lay_rows(const ParameterSet& parameters) {
  const Eigen::Vector2d along = bearing_direction(parameters.number("row_bearing_deg"));
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Vector2d centre(parameters.number("centre_x_m"), parameters.number("centre_y_m"));
  const double length_m = parameters.number("row_length_m"), half_m = 0.5 * length_m;
  const double bend_rad = rad_from_deg(parameters.number("row_bend_deg"));
  const auto count = parameters.integer("row_count");
  std::vector<RowCurve> rows;
  for (std::int64_t i = 0; i < count; ++i) {
    const double offset_m = (static_cast<double>(i) - 0.5 * static_cast<double>(count - 1)) *
                            parameters.number("pitch_m");
    if (bend_rad != 0.0) {
      rows.push_back(lay_arc(centre, along, offset_m, length_m, bend_rad));
      continue;
    }
    const Eigen::Vector2d middle = centre + offset_m * across;
    rows.emplace_back(
        std::vector<Eigen::Vector2d>{middle - half_m * along, middle + half_m * along});
  }
  return rows;
}

double calc_relief_m(const TerrainSurface& surface, const std::vector<RowCurve>& rows) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const RowCurve& row : rows) {
    const int steps = std::max(1, static_cast<int>(row.length_m() / 2.0));
    for (int i = 0; i <= steps; ++i) {
      const double height = surface.height_m(row.point_W(row.length_m() * i / steps));
      low = std::min(low, height);
      high = std::max(high, height);
    }
  }
  return high - low;
}

/// Finds the slope that gives the wanted relief under the rows. Waves alone may make up half of it
/// at most.
TerrainShape fit_relief(const ParameterSet& parameters, const std::vector<RowCurve>& rows,
                        std::uint64_t seed, double* wave_height_m) {
  const double relief_m = parameters.number("relief_m");
  const Eigen::Vector2d uphill = bearing_direction(parameters.number("uphill_bearing_deg"));
  TerrainShape shape;
  shape.centre_W = {parameters.number("centre_x_m"), parameters.number("centre_y_m")};
  shape.wave_length_m = parameters.number("wave_length_m");
  shape.wave_height_m = parameters.number("waves_m");
  const auto relief_of = [&](const TerrainShape& s) {
    return calc_relief_m(TerrainSurface(s, terrain_random(seed, "waves")), rows);
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

HeightField make_ground(const ParameterSet& parameters, const std::vector<RowCurve>& rows,
                        const std::vector<Eigen::Vector2d>& boundary_W, std::uint64_t seed,
                        const GeoOrigin& origin) {
  const Eigen::AlignedBox2d parcel = box_around(boundary_W);
  const Eigen::AlignedBox2d box = widened(parcel, parameters.number("surroundings_m"));
  TerrainShape shape;
  ParameterSet fitted = parameters;
  if (!parameters.has("dem_file")) {
    double wave_height_m = 0.0;
    shape = fit_relief(parameters, rows, seed, &wave_height_m);
    // The grid may reach one cell beyond its box.
    limit_hillside(widened(parcel, kGroundMargin_m + parameters.number("terrain_cell_m")),
                   parameters.number("slope_fade_m"), shape);
    fitted.set("waves_m", wave_height_m);
  }
  return build_terrain(fitted, seed, origin, shape, box);
}

/// The parameters with a relief: unless given, the ground is as steep as that of Parcel F.
ParameterSet with_relief(const ParameterSet& parameters) {
  constexpr double kRelief_m = 30.0, kRowLength_m = 118.0, kMost_m = 500.0;
  ParameterSet complete = parameters;
  if (!parameters.has("relief_m")) {
    const double share = parameters.number("row_length_m") / kRowLength_m;
    complete.set("relief_m", std::min(kRelief_m * share, kMost_m), "default");
  }
  return complete;
}

/// Everything that shapes a mesh file: parameters, ground, and the generator's version.
std::string mesh_key(const ParameterSet& parameters, const HeightField& terrain) {
  Hasher hasher;
  hasher.add(kGeneratorVersion);
  ParameterSet shaping = parameters;
  // Where the files lie, sun and wind, what is on the map or in the way changes no file.
  for (const char* name : {"sun_azimuth_deg", "sun_elevation_deg"}) shaping.set(name, 45.0);
  shaping.set("soil", std::string("dry_grass"));
  shaping.set("mesh_folder", std::string());
  std::vector<std::string> without{"wind", "surroundings_m", "slope_fade_m", "neighbours"};
  for (const auto& specs : {map_parameters(), obstacle_parameters()}) {
    for (const ParameterSpec& spec : specs) without.push_back(spec.name);
  }
  add_parameters(hasher, shaping, without);
  hasher.add_bytes(terrain.heights_m.data(), terrain.heights_m.size() * sizeof(float));
  return hasher.hex().substr(0, 16);
}

std::unique_ptr<WorldModel> make_vineyard(const ParameterSet& given, const WorldContext& context) {
  const ParameterSet parameters = with_relief(given);
  const VinePlanting planting = read_planting(parameters);
  auto world = std::make_unique<WorldModel>();
  world->name = "vineyard";
  world->origin = read_origin(parameters);
  read_surroundings(parameters, context.seed, *world);

  const std::vector<RowCurve> rows = lay_rows(parameters);
  const std::vector<Eigen::Vector2d> boundary =
      parcel_boundary(rows, parameters.number("headland_m"), parameters.number("pitch_m"));
  world->terrain = make_ground(parameters, rows, boundary, planting.seed, world->origin);
  const GroundHeight ground = ground_of(*world->terrain);
  world->rows = make_row_map(rows, ground, planting.canopy, boundary);
  add_alley_spawn_points(*world);
  world->scenery =
      read_neighbours(parameters, boundary, parameters.number("surroundings_m"), planting.seed);

  std::vector<VineRow> vine_rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double length_m = rows[i].length_m(), spacing_m = parameters.number("vine_spacing_m");
    const RandomStream random(planting.seed, "", fmt::format("world.missing.row_{}", i));
    VineRow row{rows[i],
                regular_vines(length_m, spacing_m, parameters.number("missing_vine_share"), random),
                spacing_m,
                {}};
    if (parameters.boolean("posts")) {
      row.post_s_m = spread_posts(0.0, length_m, planting.trellis.post_spacing_m);
    }
    vine_rows.push_back(std::move(row));
  }
  const std::filesystem::path folder = parameters.has("mesh_folder")
                                           ? std::filesystem::path(parameters.text("mesh_folder"))
                                           : find_cache_folder();
  FileMeshStore store(folder / ("vineyard-" + mesh_key(parameters, *world->terrain)));
  plant_vine_rows(*world, vine_rows, ground, planting, store);
  fill_occupancy(parameters, *world, place_obstacles(parameters, *world),
                 row_end_margin_m(planting, parameters.boolean("posts")));
  return world;
}

}  // namespace

void register_vineyard(Registry& registry) {
  registry.add_world(vineyard_spec(), make_vineyard);
}

}  // namespace vinerow::worlds
