#pragma once
/// Parameters of the map that a world gives to its vehicles, common to all worlds with rows.

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/api/parameters.h"
#include "worlds/mapping/grid/occupancy.h"

namespace vinerow::mapping {

struct MapParams {
  OccupancyOptions grid;                 ///< cell_m, virtual_walls and first_wall; cell_m = 0: none
  std::filesystem::path occupancy_file;  ///< ROS map that replaces the grid, or empty
};
/// `occupancy_cell_m`, `virtual_walls`, `first_wall`, `occupancy_file`.
const ParameterTable<MapParams>& map_table();

/// True if a set has the parameters of map_table() (worlds of plug-ins may not).
bool has_map_parameters(const ParameterSet& parameters);

/// MapParams::grid from the parameters. @pre has_map_parameters(parameters)
OccupancyOptions read_map_options(const ParameterSet& parameters);

/// Fills `world.rows->occupancy` from the file, or from rows and boundary. A block without boundary
/// gets one around its rows, and a grid of more than 8 million cells gets larger cells; notes
/// report both. Does nothing if there are neither rows nor a file, or if the cell is 0.
/// @param obstacles_W       areas that are on the map besides the rows
/// @param row_end_margin_m  extension of rows beyond their ends (leaning posts)
/// @throws ConfigError as io::load_ros_map
void fill_occupancy(const MapParams& params, WorldModel& world,
                    const std::vector<std::vector<Eigen::Vector2d>>& obstacles_W,
                    double row_end_margin_m);

}  // namespace vinerow::mapping
