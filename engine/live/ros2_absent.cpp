#include "engine/core/error.h"
#include "engine/live/ros2_bridge.h"

namespace vinerow::live {

bool has_ros2() {
  return false;
}

std::unique_ptr<Ros2Bridge> make_ros2_bridge(LiveRun&, const Ros2Options&) {
  throw ConfigError("--ros2: this program was built without Cyclone DDS");
}

}  // namespace vinerow::live
