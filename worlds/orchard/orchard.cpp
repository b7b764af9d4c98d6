#include "worlds/orchard/orchard.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "worlds/mapping/map_parameters.h"
#include "worlds/parts/common.h"
#include "worlds/parts/obstacles.h"
#include "worlds/parts/row_map.h"
#include "worlds/parts/terrain.h"
#include "worlds/parts/trees.h"

namespace vinerow::worlds {
namespace {

constexpr double kMargin_m = 10.0;  // ground beyond the field, for cameras and wide turns

PartSpec orchard_spec() {
  PartSpec spec;
  spec.name = "orchard";
  spec.description =
      "parametric orchard of straight tree rows (AgriEngineering 6 (2024) 1937, section 2.2, eq. "
      "3-4)";
  spec.parameters = concatenate(
      {{integer_parameter("plant_rows", 9, 1, 1000, "number of plant rows, n of the paper"),
        positive_parameter("row_width_m", "m", 2, "width of a plant row, w"),
        positive_parameter("row_length_m", "m", 80, "length of a plant row, l"),
        positive_parameter("field_width_m", "m", 100, "width of the field along x, L1"),
        positive_parameter("field_length_m", "m", 100, "length of the field along y, L2"),
        number_parameter("row_start_y_m", "m", 10, 0, 1e5, "where rows begin, Ys"),
        optional(positive_parameter("refinement_per_m2", "1/m2", 4,
                                    "elements per square metre, m: the map is then the paper's "
                                    "matrix, rows alone, and not the grid of occupancy_cell_m")),
        positive_parameter("tree_spacing_m", "m", 3.2, "between trees of a row"),
        positive_parameter("tree_height_m", "m", 3.6, "of the tallest trees"),
        positive_parameter("crown_base_m", "m", 0.9, "lowest leaves above ground"),
        positive_parameter("trunk_radius_m", "m", 0.07, "of tree stems"),
        number_parameter("leaf_cards_per_tree", "", 700, 20, 10000,
                         "leaves drawn per tree at close range"),
        integer_parameter("plant_seed", 1, 0, 9e15,
                          "seed of trees and ground, apart from the run's seed")},
       slope_parameters(0, 0),
       terrain_parameters(0),
       origin_parameters(45.0626, 7.6624, 240),
       surroundings_parameters(),
       map_parameters(),
       obstacle_parameters()});
  return spec;
}

OrchardLayout read_layout(const ParameterSet& parameters) {
  OrchardLayout layout;
  layout.plant_rows = static_cast<int>(parameters.integer("plant_rows"));
  layout.row_width_m = parameters.number("row_width_m");
  layout.row_length_m = parameters.number("row_length_m");
  layout.field_width_m = parameters.number("field_width_m");
  layout.field_length_m = parameters.number("field_length_m");
  layout.row_start_y_m = parameters.number("row_start_y_m");
  if (parameters.has("refinement_per_m2")) {
    layout.refinement_per_m2 = parameters.number("refinement_per_m2");
  }
  validate(layout);
  return layout;
}

TreeParams read_trees(const ParameterSet& parameters, const OrchardLayout& layout) {
  TreeParams trees;
  trees.height_m = parameters.number("tree_height_m");
  trees.crown_base_m = parameters.number("crown_base_m");
  trees.crown_width_m = layout.row_width_m;
  trees.crown_length_m = 0.95 * parameters.number("tree_spacing_m");
  trees.trunk_radius_m = parameters.number("trunk_radius_m");
  trees.leaf_cards = parameters.number("leaf_cards_per_tree");
  trees.seed = static_cast<std::uint64_t>(parameters.integer("plant_seed"));
  if (!(trees.crown_base_m < trees.height_m)) {
    throw ConfigError(fmt::format("crown_base_m = {} m, must be < tree_height_m = {} m",
                                  trees.crown_base_m, trees.height_m));
  }
  return trees;
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
  const OrchardLayout layout = read_layout(parameters);
  const TreeParams trees = read_trees(parameters, layout);
  auto world = std::make_unique<WorldModel>();
  world->name = "orchard";
  world->origin = read_origin(parameters);
  read_surroundings(parameters, context.seed, *world);

  TerrainShape shape;
  shape.centre_W = 0.5 * Eigen::Vector2d(layout.field_width_m, layout.field_length_m);
  shape.gradient = std::tan(rad_from_deg(parameters.number("slope_deg"))) *
                   bearing_direction(parameters.number("uphill_bearing_deg"));
  const Eigen::AlignedBox2d box(
      Eigen::Vector2d(-kMargin_m, -kMargin_m),
      Eigen::Vector2d(layout.field_width_m + kMargin_m, layout.field_length_m + kMargin_m));
  world->terrain = build_terrain(parameters, trees.seed, world->origin, shape, box);
  world->rows = make_map(layout, trees, *world->terrain);

  MemoryMeshStore store;
  const GroundHeight ground = ground_of(*world->terrain);
  const double spacing_m = parameters.number("tree_spacing_m");
  for (int k = 0; k < layout.plant_rows; ++k) {
    const auto& line = world->rows->rows[static_cast<std::size_t>(k)].line_W;
    const RowCurve row({line.front().head<2>(), line.back().head<2>()});
    const int count = std::max(1, static_cast<int>(row.length_m() / spacing_m + 1e-9));
    std::vector<double> stations;
    for (int i = 0; i < count; ++i) stations.push_back(row.length_m() * (i + 0.5) / count);
    plant_tree_row(*world, k, row, stations, ground, trees, store);
  }
  add_alley_spawn_points(*world);
  const auto on_map = place_obstacles(parameters, *world);
  if (parameters.has("refinement_per_m2") && !parameters.has("occupancy_file")) {
    world->rows->occupancy = make_occupancy(layout);
  } else {
    fill_occupancy(parameters, *world, on_map, 0.0);
  }
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
    throw ConfigError(fmt::format(
        "row_width_m = {} m, must be < field_width_m / (plant_rows + 1) = {} m, or no way is free",
        layout.row_width_m, layout.step_m()));
  }
  const double elements = layout.field_width_m * layout.field_length_m * layout.refinement_per_m2;
  if (elements > 1e8) {
    throw ConfigError(fmt::format(
        "refinement_per_m2 = {} 1/m2 gives {:.0f} million elements, must be at most 100",
        layout.refinement_per_m2, elements / 1e6));
  }
}

OccupancyGrid make_occupancy(const OrchardLayout& layout) {
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
