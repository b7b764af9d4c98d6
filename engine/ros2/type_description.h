#pragma once
/// Type descriptions of ROS 2 messages and services, in the form that ROS 2 hashes (type_hash.h).
///
/// Source: REP-2011 and rosidl_generator_type_description (ROS 2 Jazzy). record::RosSchema drops
/// what decoding does not need (bounds, `byte` apart from `uint8`), so this folder has a parser of
/// its own.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vinerow::ros2 {

struct FieldDescription {
  std::string name;
  int type_id = 0;                  ///< constant of type_description_interfaces/msg/FieldType
  std::uint64_t capacity = 0;       ///< length of an array, limit of a bounded sequence
  std::uint64_t text_capacity = 0;  ///< limit of a bounded string
  std::string nested_type;          ///< "geometry_msgs/msg/Pose"; empty for numbers and text
};

/// The types of one definition, by full name ("sensor_msgs/msg/Imu").
using TypeDescriptions = std::map<std::string, std::vector<FieldDescription>>;

/// Parses a message definition.
/// @param name  "sensor_msgs/msg/Imu"
/// @param text  encoding "ros2msg": the .msg text, then each nested type after a line of "=" and a
///              line "MSG: package/Type"
/// @throws ConfigError "the definition of a/msg/B has the line 'float64', must be a type and a
/// name"
TypeDescriptions describe_message(std::string_view name, std::string_view text);

/// Parses a service definition: `name` + "_Request", "_Response", "_Event" and `name` itself.
/// @param name  "std_srvs/srv/Trigger"
/// @param text  the .srv text (request, "---", response), then nested types as in a message
TypeDescriptions describe_service(std::string_view name, std::string_view text);

}  // namespace vinerow::ros2
