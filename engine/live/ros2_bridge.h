#pragma once
/// A live run as a ROS 2 node: topics, commands and services (engine/ros2).

#include <memory>
#include <string>

#include "engine/live/live_run.h"

namespace vinerow::live {

struct Ros2Options {
  int domain = 0;                      ///< ROS_DOMAIN_ID
  bool network = false;                ///< false: only programs on this machine see the node
  std::string distribution = "jazzy";  ///< "humble" | "jazzy": forms of messages that differ
  bool holds_start = false;            ///< in lock-step: wait at time 0 for the commanding node
};

/// Whether this program was built with Cyclone DDS.
bool has_ros2();

class Ros2Bridge {
 public:
  virtual ~Ros2Bridge() = default;
};

/// Joins the domain as node "/vinerow" and takes part in the run.
///
/// | topic | type | QoS |
/// |---|---|---|
/// | /clock | rosgraph_msgs/msg/Clock | best effort, last 1 |
/// | /tf, /tf_static | tf2_msgs/msg/TFMessage | reliable, last 100; latched |
/// | /<vehicle>/<signal> | as in the log, without "/exact" | sensors: best effort, last 5; plans
/// and maps: latched; others: reliable, last 10 | | /<vehicle>/cmd_vel and others | in: see
/// command_codec.h | reliable, last 10 | | /vinerow/step_simulation and others |
/// simulation_interfaces | services |
///
/// @param run  outlives the bridge
/// @throws ConfigError as ros2::Node, or if the program was built without Cyclone DDS
std::unique_ptr<Ros2Bridge> make_ros2_bridge(LiveRun& run, const Ros2Options& options);

}  // namespace vinerow::live
