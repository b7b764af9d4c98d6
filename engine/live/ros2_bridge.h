#pragma once
/// A live run as a ROS 2 node: topics, commands and services (engine/ros2).

#include <filesystem>
#include <memory>
#include <string>

#include "engine/live/live_run.h"
#include "engine/live/transform_tree.h"

namespace vinerow::live {

struct Ros2Options {
  int domain = 0;                      ///< 0 .. 232
  bool network = false;                ///< false: only programs on this machine see the node
  std::string distribution = "jazzy";  ///< "humble" | "jazzy": forms of messages that differ
  Localisation localisation = Localisation::kTruth;  ///< who gives map -> <vehicle>/odom
  bool is_lockstep = false;  ///< commands carry a stamp: cmd_vel is TwistStamped, otherwise Twist
  bool holds_start = false;  ///< wait at time 0 until a node commands and reads a topic
  std::filesystem::path out = {};  ///< of the run's files, for meshes; empty: none are written
};

/// Whether this program was built with Cyclone DDS.
bool has_ros2();

class Ros2Bridge {
 public:
  virtual ~Ros2Bridge() = default;
};

/// Joins the domain as node "/vinerow" and takes part in the run. Topics, their QoS and services:
/// docs/guides/live.md.
/// @param run  outlives the bridge
/// @throws ConfigError as ros2::Node, or if the program was built without Cyclone DDS
std::unique_ptr<Ros2Bridge> make_ros2_bridge(LiveRun& run, const Ros2Options& options);

}  // namespace vinerow::live
