#include "worlds/orchard/orchard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "worlds/mapping/from_truth/map_parameters.h"
#include "worlds/parts/alley_spawns.h"
#include "worlds/parts/common.h"
#include "worlds/parts/leaf_area.h"
#include "worlds/parts/obstacles.h"
#include "worlds/parts/terrain.h"
#include "worlds/plants/trees.h"
#include "worlds/plants/weeds.h"

namespace vinerow::worlds {
namespace {

struct OrchardParams {
  OrchardLayout layout;
  double surroundings_m = 10.0;
  std::optional<double> refinement_per_m2;  ///< given: the map is the paper's matrix
  double tree_spacing_m = 3.2;
  TreeParams trees;
  std::optional<WeedParams> weeds;
  SlopeParams slope;
  TerrainParams terrain;
  GeoOrigin origin{rad_from_deg(45.0626), rad_from_deg(7.6624), 240.0};
  Surroundings surroundings;
  mapping::MapParams map;
  ObstaclesParams obstacles;
};

const ParameterTable<OrchardParams>& orchard_table() {
  using P = OrchardParams;
  using Layout = OrchardLayout;
  using Trees = TreeParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("plant_rows", inside(&P::layout, &Layout::plant_rows), between(1, 1000),
                   "number of plant rows, n of the paper")
          .number("row_width_m", "m", inside(&P::layout, &Layout::row_width_m), kPositive,
                  "width of a plant row, w")
          .number("row_length_m", "m", inside(&P::layout, &Layout::row_length_m), kPositive,
                  "length of a plant row, l")
          .number("field_width_m", "m", inside(&P::layout, &Layout::field_width_m), kPositive,
                  "width of the field along x, L1")
          .number("field_length_m", "m", inside(&P::layout, &Layout::field_length_m), kPositive,
                  "length of the field along y, L2")
          .number("surroundings_m", "m", &P::surroundings_m, between(10.0, 5000.0),
                  "ground beyond the field; aircraft need room to turn")
          .number("row_start_y_m", "m", inside(&P::layout, &Layout::row_start_y_m),
                  between(0.0, 1e5), "start of the rows, Ys")
          .number("refinement_per_m2", "1/m2", &P::refinement_per_m2, kPositive,
                  "elements per square metre, m: the map is then the paper's "
                  "matrix, rows alone, and not the grid of occupancy_cell_m")
          .number("tree_spacing_m", "m", &P::tree_spacing_m, between(0.1, 100.0),
                  "distance between trees of a row")
          .number("tree_height_m", "m", inside(&P::trees, &Trees::height_m), above(0.0, 60.0),
                  "height of the tallest trees")
          .number("crown_base_m", "m", inside(&P::trees, &Trees::crown_base_m), above(0.0, 60.0),
                  "lowest leaves above ground")
          .number("trunk_radius_m", "m", inside(&P::trees, &Trees::trunk_radius_m), above(0.0, 2.0),
                  "radius of tree stems")
          .number("leaf_cards_per_tree", "", inside(&P::trees, &Trees::leaf_cards),
                  between(20.0, 10000.0), "leaves drawn per tree at close range")
          .group("leaves", inside(&P::trees, &Trees::leaves), tree_leaves_table(),
                 "leaves and fruit one by one; absent: cards of leaves")
          .group("weeds", &P::weeds, weed_table(), kWeedsText)
          .integer("plant_seed", inside(&P::trees, &Trees::seed), between(0, 9e15),
                   "seed of trees and ground, apart from the run's seed")
          .include(&P::slope, slope_table())
          .include(&P::terrain, terrain_table())
          .include(&P::origin, origin_table())
          .include(&P::surroundings, surroundings_table())
          .include(&P::map, mapping::map_table())
          .include(&P::obstacles, obstacles_table())
          .rule([](const P& p) -> std::string {
            if (p.trees.crown_base_m < p.trees.height_m) return "";
            return fmt::format("crown_base_m = {} m, must be < tree_height_m = {} m",
                               p.trees.crown_base_m, p.trees.height_m);
          });
  return table;
}

PartSpec orchard_spec() {
  PartSpec spec;
  spec.name = "orchard";
  spec.description =
      "parametric orchard of straight tree rows (AgriEngineering 6 (2024) 1937, section 2.2, eq. "
      "3-4)";
  orchard_table().add_to(spec);
  return spec;
}

OrchardParams read_orchard(const ParameterSet& parameters) {
  OrchardParams params = orchard_table().read(parameters, "");
  OrchardLayout& layout = params.layout;
  layout.refinement_per_m2 = params.refinement_per_m2.value_or(layout.refinement_per_m2);
  validate(layout);
  params.trees.crown_width_m = layout.row_width_m;
  // The crown of a single tree ends with its row.
  params.trees.crown_length_m = 0.95 * std::min(params.tree_spacing_m, layout.row_length_m);
  return params;
}

/// Rows and all N free rows, as the paper numbers them from x = 0.
RowMap make_map(const OrchardLayout& layout, const TreeParams& trees, const HeightField& terrain) {
  RowMap map;
  const double from_m = layout.row_start_y_m, to_m = from_m + layout.row_length_m;
  const auto line = [&](double x) {
    return std::vector<Eigen::Vector3d>{{x, from_m, terrain.height_m(x, from_m)},
                                        {x, to_m, terrain.height_m(x, to_m)}};
  };
  for (int k = 0; k < layout.plant_rows; ++k) {
    map.rows.push_back({k, line((k + 1) * layout.step_m()), layout.row_width_m, trees.crown_base_m,
                        trees.height_m});
  }
  for (int k = 0; k < layout.free_rows(); ++k) {
    map.alleys.push_back({k, line((k + 0.5) * layout.step_m()), layout.step_m()});
  }
  map.boundary_W = {{0, 0},
                    {layout.field_width_m, 0},
                    {layout.field_width_m, layout.field_length_m},
                    {0, layout.field_length_m}};
  return map;
}

std::unique_ptr<WorldModel> make_orchard(const ParameterSet& parameters,
                                         const WorldContext& context) {
  const OrchardParams params = read_orchard(parameters);
  const OrchardLayout& layout = params.layout;
  const TreeParams& trees = params.trees;
  auto world = std::make_unique<WorldModel>();
  world->name = "orchard";
  world->origin = params.origin;
  set_surroundings(params.surroundings, context.seed, *world);
  world->depends_on_seed = false;  // plants and terrain have a seed of their own

  TerrainShape shape;
  shape.centre_W = 0.5 * Eigen::Vector2d(layout.field_width_m, layout.field_length_m);
  shape.gradient = params.slope.gradient();
  const Eigen::Vector2d beyond = Eigen::Vector2d::Constant(params.surroundings_m);
  const Eigen::AlignedBox2d box(
      -beyond, Eigen::Vector2d(layout.field_width_m, layout.field_length_m) + beyond);
  world->terrain = build_terrain(params.terrain, trees.seed, world->origin, shape, box);
  world->rows = make_map(layout, trees, *world->terrain);

  MemoryMeshStore store;
  const mapping::GroundHeight ground = ground_of(*world->terrain);
  std::vector<mapping::RowCurve> rows;
  for (const PlantRow& row : world->rows->rows) {
    rows.emplace_back(
        std::vector<Eigen::Vector2d>{row.line_W.front().head<2>(), row.line_W.back().head<2>()});
  }
  if (params.weeds) check_weeds(rows, *params.weeds);
  for (int k = 0; k < layout.plant_rows; ++k) {
    const mapping::RowCurve& row = rows[static_cast<std::size_t>(k)];
    const int count = std::max(1, static_cast<int>(row.length_m() / params.tree_spacing_m + 1e-9));
    std::vector<double> stations;
    for (int i = 0; i < count; ++i) stations.push_back(row.length_m() * (i + 0.5) / count);
    plant_tree_row(*world, k, row, stations, ground, trees, store);
  }
  if (params.weeds) plant_weeds(*world, rows, ground, *params.weeds, trees.seed, store);
  add_alley_spawn_points(*world);
  const auto on_map = place_obstacles(params.obstacles, *world);
  if (params.refinement_per_m2 && params.map.occupancy_file.empty()) {
    world->rows->occupancy = make_occupancy(layout);
  } else {
    mapping::fill_occupancy(params.map, *world, on_map, 0.0);
  }
  settle_shelter(*world);
  return world;
}

}  // namespace

void validate(const OrchardLayout& layout) {
  if (layout.row_start_y_m + layout.row_length_m > layout.field_length_m) {
    throw ConfigError(
        fmt::format("row_start_y_m + row_length_m = {} m, must be <= field_length_m = {} m",
                    layout.row_start_y_m + layout.row_length_m, layout.field_length_m));
  }
  if (layout.row_width_m >= layout.step_m()) {
    throw ConfigError(
        fmt::format("row_width_m = {} m, must be < field_width_m / (plant_rows + 1) = {} m, or no "
                    "alley is free",
                    layout.row_width_m, layout.step_m()));
  }
}

OccupancyGrid make_occupancy(const OrchardLayout& layout) {
  const double elements = layout.field_width_m * layout.field_length_m * layout.refinement_per_m2;
  if (elements > 1e8) {
    throw ConfigError(fmt::format(
        "refinement_per_m2 = {} 1/m2 gives {:.0f} million elements, must be at most 100 million",
        layout.refinement_per_m2, elements / 1e6));
  }
  OccupancyGrid grid;
  grid.cell_m = 1.0 / std::sqrt(layout.refinement_per_m2);
  grid.columns = static_cast<int>(std::ceil(layout.field_width_m / grid.cell_m - 1e-9));
  grid.rows = static_cast<int>(std::ceil(layout.field_length_m / grid.cell_m - 1e-9));
  grid.cells.assign(static_cast<std::size_t>(grid.columns) * grid.rows, 0);
  for (int j = 0; j < grid.rows; ++j) {
    const double y = (j + 0.5) * grid.cell_m - layout.row_start_y_m;
    if (y < 0.0 || y > layout.row_length_m) continue;
    for (int i = 0; i < grid.columns; ++i) {
      const double x = (i + 0.5) * grid.cell_m;
      const double k = std::round(x / layout.step_m());
      if (k < 1.0 || k > layout.plant_rows) continue;
      if (std::abs(x - k * layout.step_m()) <= 0.5 * layout.row_width_m) {
        grid.cells[static_cast<std::size_t>(j) * grid.columns + i] = 1;
      }
    }
  }
  return grid;
}

void register_orchard(Registry& registry) {
  registry.add_world(orchard_spec(), make_orchard);
}

}  // namespace vinerow::worlds
