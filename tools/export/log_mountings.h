#pragma once
/// Mountings of sensors by the log's /tf_static.

#include <string>
#include <vector>

#include "engine/math/pose.h"
#include "engine/record/mcap_reader.h"

namespace vinerow::tools {

struct Mounting {
  std::string body, sensor;  ///< frames: "rover/base_link", "rover/lidar"
  Pose X_BS;
};

/// @returns none if the log has no such topic
std::vector<Mounting> read_mountings(record::McapReader& log);

}  // namespace vinerow::tools
