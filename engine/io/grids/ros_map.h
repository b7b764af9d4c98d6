#pragma once
/// Occupancy grids as ROS maps: a PGM picture and a YAML file beside it, as map_server, map_saver
/// and Nav2 read and write them.
///
/// Source: the ROS wiki's page of map_server (section "Map format"); nav2_map_server's map_io.
/// A pixel of value x is taken with p = (maximum - x) / maximum, or x / maximum with `negate`:
/// p > occupied_thresh taken, p < free_thresh free, between them unknown.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/api/messages/grid.h"

namespace vinerow::io {

struct RosMap {
  OccupancyGrid grid;
  std::vector<std::string> notes;  ///< how many cells are unknown; they count as taken
};

/// Reads the YAML file and the picture that it names. Only `mode: trinary` and maps that are not
/// turned (origin yaw 0). Keys that are not of the format are left to others.
/// @throws ConfigError in one sentence naming the file
RosMap load_ros_map(const std::filesystem::path& yaml_file);

/// Writes `<yaml_file>` and beside it the picture of the same name with .pgm: 254 free, 0 taken.
/// load_ros_map() gives the same grid, bit for bit. @throws ConfigError if a file cannot be written
void save_ros_map(const OccupancyGrid& grid, const std::filesystem::path& yaml_file);

}  // namespace vinerow::io
