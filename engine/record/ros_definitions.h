#pragma once
/// The .msg texts of the ROS 2 message types that a log holds, so that a log explains itself: a
/// reader needs no ROS installation to decode it.

#include <string>
#include <string_view>

namespace vinerow::record {

/// Text of one type as MCAP wants it ("ros2msg"): its own definition, then every type it uses,
/// directly or not, each behind a line of 80 "=" and "MSG: package/Type".
/// @param type  "nav_msgs/msg/Odometry"; one of the types of ros_mapping.h
std::string full_ros_definition(std::string_view type);

}  // namespace vinerow::record
