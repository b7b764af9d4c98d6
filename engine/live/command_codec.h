#pragma once
/// Commands from outside as ROS 2 messages.
///
/// | signal's type | message types |
/// |---|---|
/// | VelocityCommand | geometry_msgs/msg/Twist, geometry_msgs/msg/TwistStamped |
/// | NamedValues | sensor_msgs/msg/JointState, vinerow_msgs/msg/NamedValues |
/// | Odometry | geometry_msgs/msg/PoseWithCovarianceStamped, nav_msgs/msg/Odometry |
/// | PoseTarget | geometry_msgs/msg/PoseStamped |
/// | any built-in type | its message in the log, e.g. vinerow_msgs/msg/LocalCommand |

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/api/outside.h"

namespace vinerow::live {

/// Types of messages that a signal accepts, the preferred one first. "" if it is no built-in type.
/// @param message_type  kType of the signal's message
std::vector<std::string> command_types(const std::string& message_type);

/// @returns the full name of the type, "geometry_msgs/msg/Twist"
/// @throws ConfigError if the type does not fit the signal
std::string check_command_type(const std::string& signal, const std::string& message_type,
                               const std::string& ros_type);

/// Whether messages of a type have a header, whose stamp lock-step needs.
bool has_header(const std::string& ros_type);

/// Definition of one of command_types(), in the encoding "ros2msg".
std::string command_definition(const std::string& message_type, const std::string& ros_type);

/// Decodes a command. Its stamp is that of the message's header, 0 without one.
/// @param signal  "rover/cmd_vel"
/// @param message_type  kType of the signal's message
/// @param ros_type  "geometry_msgs/msg/Twist"; also without "msg/"
/// @param cdr  with its encapsulation header
/// @throws ConfigError if the type does not fit the signal, the bytes are not such a message, or a
///   pose is not in the world's frame or has no orientation
OutsideCommand decode_command(const std::string& signal, const std::string& message_type,
                              const std::string& ros_type, std::span<const std::uint8_t> cdr);

}  // namespace vinerow::live
