#pragma once
/// RIHS01, the type hash of ROS 2 (Iron and later): a publisher announces it in its user data, and
/// `ros2 topic info -v` shows it.
///
/// Source: REP-2016 and rosidl_generator_type_description: SHA-256 of the type description as JSON.
/// Names and types of fields count, also of nested types; constants, default values and comments do
/// not.

#include <string>
#include <string_view>

namespace vinerow::ros2 {

/// @param name  "sensor_msgs/msg/Imu"  @param text  encoding "ros2msg", as stored in logs
/// @returns "RIHS01_" and 64 hexadecimal digits
/// @throws ConfigError as describe_message()
std::string message_type_hash(std::string_view name, std::string_view text);

/// Hashes of a service: DDS endpoints announce those of request and response.
struct ServiceTypeHashes {
  std::string service;
  std::string request;
  std::string response;
};

/// @param name  "std_srvs/srv/Trigger"  @param text  the .srv text and nested types
ServiceTypeHashes service_type_hashes(std::string_view name, std::string_view text);

}  // namespace vinerow::ros2
