#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/io/files/output_folder.h"
#include "engine/io/grids/ros_map.h"
#include "engine/sim/simulation.h"
#include "tools/pictures/grid_picture.h"
#include "tools/vinerow/subcommands.h"
#include "worlds/mapping/from_truth/map_parameters.h"

namespace vinerow::tools {
namespace {

void print_grid(const WorldModel& world, const mapping::OccupancyReport& report) {
  const OccupancyGrid& grid = world.rows->occupancy;
  fmt::print("rows           {}\n", world.rows->rows.size());
  fmt::print("alleys         {}\n", world.rows->alleys.size());
  fmt::print("cells          {} x {} of {:g} m, {:.2f} million, {:.1f} % free\n", grid.columns,
             grid.rows, grid.cell_m, 1e-6 * static_cast<double>(grid.cells.size()),
             100.0 * mapping::free_share(grid));
  fmt::print("virtual walls  {}\n", report.walls.size());
  if (report.turning_areas.empty()) {
    fmt::print("turning areas  0\n");
    return;
  }
  const auto [narrow, wide] =
      std::minmax_element(report.turning_areas.begin(), report.turning_areas.end(),
                          [](const auto& a, const auto& b) { return a.width_m < b.width_m; });
  fmt::print("turning areas  {}, {:.3f} m wide (row {}) to {:.3f} m (row {})\n",
             report.turning_areas.size(), narrow->width_m, narrow->row, wide->width_m, wide->row);
}

}  // namespace

void add_grid_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    ScenarioArguments scenario;
    std::filesystem::path out;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "grid", "write the occupancy grid of a scenario's world as a ROS map and as a picture");
  add_scenario_arguments(*command, arguments->scenario, "world.row_count=8");
  command->add_option("--out", arguments->out,
                      "folder for map.yaml, map.pgm and grid.png (default: maps/<scenario name>)");
  command->callback([arguments, &exit_status] {
    Registry registry;
    const scenario::Scenario scenario = load(arguments->scenario, registry);
    const auto world = build_world(scenario, registry);
    for (const std::string& note : world->notes) fmt::print("note: {}\n", note);
    if (world->rows->occupancy.empty()) {
      throw ConfigError(
          fmt::format("{}: world '{}' has no occupancy grid (no rows, or occupancy_cell_m = 0)",
                      arguments->scenario.file.string(), scenario.world.type));
    }
    mapping::OccupancyReport report;
    const ParameterSet& parameters = scenario.world.parameters;
    // A map from a file gets no virtual walls: it already contains its own.
    if (mapping::has_map_parameters(parameters) && !parameters.find("occupancy_file")) {
      report = mapping::plan_occupancy(world->rows, mapping::read_map_options(parameters));
    }
    const std::filesystem::path out =
        arguments->out.empty() ? std::filesystem::path("maps") / scenario.name : arguments->out;
    io::make_folder(out);
    io::save_ros_map(world->rows->occupancy, out / "map.yaml");
    render::write_png((out / "grid.png").string(), draw_grid(*world, report, scenario.name));
    print_grid(*world, report);
    fmt::print("map            {}\npicture        {}\n", (out / "map.yaml").string(),
               (out / "grid.png").string());
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
