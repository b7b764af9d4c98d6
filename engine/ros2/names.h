#pragma once
/// Names of ROS 2 topics, services, nodes and types, and their DDS forms.
///
/// Source: https://design.ros2.org/articles/topic_and_service_names.html and
/// rmw_cyclonedds_cpp (prefixes "rt", "rq", "rr").

#include <string>
#include <string_view>

namespace vinerow::ros2 {

/// @throws ConfigError "node name 'a-b', must start with a letter or '_' and have letters, digits
/// and '_' only"
void check_node_name(std::string_view name);

/// @throws ConfigError "node namespace 'farm', must be '/' or start with '/' ..."
void check_name_space(std::string_view name_space);

/// @throws ConfigError "message type 'Imu', must be package/msg/Type or package/srv/Type"
void check_type_name(std::string_view type);

/// Full name of a topic or service: "/a" stays, "a" is relative to the namespace, "~/a" to the
/// node.
/// @throws ConfigError "topic '/a//b', must ..." if the full name is not valid
std::string resolve_name(std::string_view name, std::string_view name_space,
                         std::string_view node_name);

/// "sensor_msgs::msg::dds_::Imu_" for "sensor_msgs/msg/Imu".
/// @throws ConfigError as check_type_name()
std::string dds_type_name(std::string_view type);

}  // namespace vinerow::ros2
