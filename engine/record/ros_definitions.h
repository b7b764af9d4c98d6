#pragma once
/// The .msg texts of the standard ROS 2 messages in a log. The log contains them, so that it can be
/// decoded without a ROS installation.

#include <span>
#include <string>
#include <string_view>

namespace vinerow::record {

/// A message and its .msg text.
struct RosDefinition {
  std::string type;  ///< "package/Type"
  std::string text;
};

/// Definition in MCAP's encoding "ros2msg": the text, then every type that it uses, directly or
/// indirectly, each after a line of 80 "=" and a line "MSG: package/Type".
/// @param inside  nested types that are not standard types
std::string full_ros_definition(std::string_view text, std::span<const RosDefinition> inside);

/// The same for a standard type. @param type  a type of ros_mapping.h, such as
/// "nav_msgs/msg/Odometry"
std::string full_ros_definition(std::string_view type);

}  // namespace vinerow::record
