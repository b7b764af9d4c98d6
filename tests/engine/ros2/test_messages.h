#pragma once
/// Messages in CDR for the tests, and domains that parallel tests do not share.

#include <unistd.h>

#include <chrono>
#include <string_view>
#include <thread>
#include <vector>

#include "engine/record/cdr.h"
#include "engine/ros2/node.h"

namespace vinerow::ros2 {

/// ROS domain of this process, away from the default 0.
inline int test_domain() {
  return 20 + static_cast<int>(getpid() % 80);
}

inline NodeOptions test_options(const char* name = "vinerow") {
  NodeOptions options;
  options.name = name;
  options.domain_id = test_domain();
  return options;
}

inline std::vector<std::uint8_t> bytes_of(const record::ByteBuffer& buffer) {
  return {buffer.data(), buffer.data() + buffer.size()};
}

/// sensor_msgs/msg/Imu
inline std::vector<std::uint8_t> imu_message(std::int32_t sec, double yaw_rate_radps) {
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  out.add(sec);
  out.add(std::uint32_t{5});
  out.add(std::string_view("rover/imu"));
  for (const double q : {0.0, 0.0, 0.0, 1.0}) out.add(q);
  out.add_zero_doubles(9);
  for (const double w : {0.0, 0.0, yaw_rate_radps}) out.add(w);
  out.add_zero_doubles(9 + 3 + 9);
  return bytes_of(buffer);
}

/// std_msgs/msg/String
inline std::vector<std::uint8_t> text_message(std::string_view text) {
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  out.add(text);
  return bytes_of(buffer);
}

/// Polls a condition for at most 10 s.
template <class Condition>
bool eventually(Condition condition) {
  for (int i = 0; i < 2000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

}  // namespace vinerow::ros2
