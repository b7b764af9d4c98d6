#pragma once
/// Reader and writer of occupancy grids as ROS maps: a PGM picture and a YAML file in the same
/// folder, as used by map_server, map_saver and Nav2.
///
/// Source: ROS wiki, map_server (section "Map format"); nav2_map_server, map_io. A pixel of value x
/// has the occupancy probability p = (maximum - x) / maximum, or x / maximum with `negate`. It is
/// occupied if p > occupied_thresh, free if p < free_thresh, else unknown.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/api/messages/grid.h"

namespace vinerow::io {

struct RosMap {
  OccupancyGrid grid;
  std::vector<std::string> notes;  ///< number of unknown cells; they count as occupied
};

/// Reads the YAML file and the picture that it names. Only `mode: trinary` and maps without
/// rotation (origin yaw 0) are supported. Keys that are not part of the format are ignored.
/// @throws ConfigError in one sentence naming the file
RosMap load_ros_map(const std::filesystem::path& yaml_file);

/// Writes `<yaml_file>` and next to it the picture of the same name with .pgm: 254 free, 0
/// occupied. load_ros_map() returns the same grid, bit for bit. @throws ConfigError if a file
/// cannot be written
void save_ros_map(const OccupancyGrid& grid, const std::filesystem::path& yaml_file);

}  // namespace vinerow::io
