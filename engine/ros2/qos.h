#pragma once
/// Quality of service of topics, with the profiles that ROS 2 nodes use.

namespace vinerow::ros2 {

/// History is always "keep last": a writer with it never waits for a slow reader, it overwrites.
struct Qos {
  bool reliable = true;          ///< resend lost messages; false: best effort
  bool transient_local = false;  ///< late subscribers get the last `depth` messages
  int depth = 10;                ///< messages kept per reader and writer, at least 1
};

constexpr Qos kSensorDataQos{false, false, 5};   ///< rclcpp::SensorDataQoS
constexpr Qos kDefaultQos{true, false, 10};      ///< rmw_qos_profile_default
constexpr Qos kLatchedQos{true, true, 1};        ///< /tf_static, maps, robot descriptions
constexpr Qos kTransformsQos{true, false, 100};  ///< /tf, tf2_ros::DynamicBroadcasterQoS
constexpr Qos kClockQos{false, false, 1};        ///< /clock, rclcpp::ClockQoS
constexpr Qos kServicesQos{true, false, 10};     ///< rmw_qos_profile_services_default

}  // namespace vinerow::ros2
