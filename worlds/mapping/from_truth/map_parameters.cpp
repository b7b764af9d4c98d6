#include "worlds/mapping/from_truth/map_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/io/grids/ros_map.h"
#include "worlds/mapping/model/row_map.h"

namespace vinerow::mapping {
namespace {

constexpr std::int64_t kMaxCells = 8'000'000;

void give_boundary(WorldModel& world) {
  constexpr double kHeadland_m = 10.0, kLateralOffset_m = 3.0;
  std::vector<RowCurve> rows;
  for (const PlantRow& row : world.rows->rows) rows.emplace_back(from_above(row.line_W));
  world.rows->boundary_W = parcel_boundary(rows, kHeadland_m, kLateralOffset_m);
  world.notes.push_back(
      fmt::format("the parcel has no boundary; a box {:g} m beyond the row ends and {:g} m beside "
                  "the outer rows is used instead",
                  kHeadland_m, kLateralOffset_m));
}

}  // namespace

const ParameterTable<MapParams>& map_table() {
  using P = MapParams;
  using Grid = OccupancyOptions;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("occupancy_cell_m", "m", inside(&P::grid, &Grid::cell_m), between(0.0, 10.0),
                  "cell of the vehicles' occupancy grid; 0: no grid")
          .boolean("virtual_walls", inside(&P::grid, &Grid::virtual_walls),
                   "walls on the map from row ends to the boundary, so that only the "
                   "serpentine is free")
          .choice("first_wall", inside(&P::grid, &Grid::first_wall),
                  {{"auto", std::nullopt}, {"first", RowEnd::kFirst}, {"last", RowEnd::kLast}},
                  "point of row 0 that is closed by a virtual wall, the ends of the others "
                  "alternate; auto: open for a serpentine that starts at alley 0's first point")
          .path("occupancy_file", &P::occupancy_file,
                "ROS map (YAML with a PGM beside it) that vehicles are given instead of "
                "the true rows");
  return table;
}

bool has_map_parameters(const ParameterSet& parameters) {
  const auto& specs = parameters.specs();
  return std::any_of(specs.begin(), specs.end(),
                     [](const ParameterSpec& spec) { return spec.name == "occupancy_cell_m"; });
}

OccupancyOptions read_map_options(const ParameterSet& parameters) {
  return map_table().read(parameters, "").grid;
}

void fill_occupancy(const MapParams& params, WorldModel& world,
                    const std::vector<std::vector<Eigen::Vector2d>>& obstacles_W,
                    double row_end_margin_m) {
  if (!params.occupancy_file.empty()) {
    io::RosMap map = io::load_ros_map(params.occupancy_file);
    world.rows->occupancy = std::move(map.grid);
    for (std::string& note : map.notes) world.notes.push_back(std::move(note));
    return;
  }
  OccupancyOptions options = params.grid;
  if (options.cell_m == 0.0 || world.rows->rows.empty()) return;
  if (world.rows->boundary_W.empty()) give_boundary(world);
  const double wanted_m = options.cell_m;
  options.cell_m = cell_that_fits_m(world.rows->boundary_W, wanted_m, kMaxCells);
  if (options.cell_m != wanted_m) {
    world.notes.push_back(fmt::format(
        "occupancy_cell_m = {:g} m would make more than {} million cells; {:g} m is used", wanted_m,
        kMaxCells / 1'000'000, options.cell_m));
  }
  options.obstacles_W = obstacles_W;
  options.row_end_margin_m = row_end_margin_m;
  const OccupancyReport report = plan_occupancy(world.rows, options);
  world.rows->occupancy = make_occupancy_grid(world.rows, options, report);
  for (const std::string& note : report.notes) world.notes.push_back(note);
}

}  // namespace vinerow::mapping
