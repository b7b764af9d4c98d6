#pragma once
/// The .msg texts of the standard ROS 2 messages that a log holds, so that a log explains itself: a
/// reader needs no ROS installation to decode it.

#include <span>
#include <string>
#include <string_view>

namespace vinerow::record {

/// A message and its .msg text.
struct RosDefinition {
  std::string type;  ///< "package/Type"
  std::string text;
};

/// A text as MCAP wants it ("ros2msg"): itself, then every type it uses, directly or not, each
/// behind a line of 80 "=" and "MSG: package/Type".
/// @param inside  types that are no standard ones
std::string full_ros_definition(std::string_view text, std::span<const RosDefinition> inside);

/// The same of a standard type. @param type  "nav_msgs/msg/Odometry"; one of those of ros_mapping.h
std::string full_ros_definition(std::string_view type);

}  // namespace vinerow::record
