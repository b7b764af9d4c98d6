#pragma once
/// Runs of vehicles under an autopilot, for tests.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <utility>

#include "engine/core/error.h"
#include "engine/mavlink/tcp_server.h"
#include "engine/mavlink/udp_socket.h"
#include "tests/controllers/autopilot/fake_px4.h"
#include "tests/scenarios/session_support.h"
#include "vinerow/session.h"

namespace vinerow::autopilot_test {

inline constexpr std::int64_t kSecond = 1'000'000'000;
inline constexpr std::uint32_t kLoopback = 0x7F000001;

inline void replace(std::string& text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
}

inline Session open(const std::string& text, const std::filesystem::path& products = {}) {
  SessionOptions options;
  options.products = products;
  return open_session_text(text, ".", {}, std::move(options));
}

/// The rover of session_support.h, before the alley and with its back to it.
inline std::string rover_text(const std::string& autopilot) {
  std::string text = test::kFreeRover;
  replace(text, "duration_s: 3", "duration_s: 40");
  replace(text, "type: vineyard,", "type: vineyard, pitch_m: 6,");  // room to turn
  replace(text, "spawn: {alley: 0}", "spawn: {alley: 0, offset_m: 3, turn_deg: 150}");
  return text + "    autopilot: {" + autopilot + "}\n";
}

inline std::string fault_of(const std::string& text, std::int64_t seconds = 1) {
  try {
    Session session = open(text);
    session.advance(Time{seconds * kSecond});
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

/// An instance whose port nobody uses: tests run side by side.
/// @param is_free  throws ConfigError if the instance is taken
template <class IsFree>
int free_instance_of(IsFree&& is_free) {
  for (int k = 0; k < 200; ++k) {
    const int instance = 20 + (static_cast<int>(::getpid()) + k) % 200;
    try {
      is_free(instance);
      return instance;
    } catch (const ConfigError&) {
    }
  }
  ADD_FAILURE() << "no free port";
  return 0;
}

inline std::uint16_t px4_port_of(int instance) {
  return static_cast<std::uint16_t>(4560 + instance);
}

inline int free_px4_instance() {
  return free_instance_of([](int instance) {
    mavlink::TcpServer({kLoopback, px4_port_of(instance)}, "");
  });
}

inline controllers::FakePx4Options px4_options(int instance) {
  controllers::FakePx4Options options;
  options.port = px4_port_of(instance);
  return options;
}

/// Keys of the autopilot that name the sensors below.
inline const std::string kPx4Sensors =
    ", imu: imu, magnetometer: compass, barometer: barometer, gnss: gps";
inline const std::string kPx4SensorList =
    "imu: {type: imu, rate_Hz: 250}, compass: {type: magnetometer, rate_Hz: 50}, "
    "barometer: {type: barometer, rate_Hz: 25}, "
    "sonar: {type: ultrasound, rate_Hz: 20, position_m: [0.4, 0, 0.3]}";

/// Without MAVLink unless `more` has parameters.
inline std::string px4(int instance, const std::string& more = "", int rate_Hz = 100) {
  const bool has_mavlink = more.find("parameters") != std::string::npos;
  return "type: px4, rate_Hz: " + std::to_string(rate_Hz) +
         ", answer_timeout_s: 5, instance: " + std::to_string(instance) + kPx4Sensors +
         (has_mavlink ? "" : ", mavlink: false") + more;
}

/// The rover with the sensors that PX4 needs, at 45 N, 9 E, 150 m.
inline std::string px4_rover_text(const std::string& autopilot) {
  std::string text = rover_text(autopilot);
  replace(text, "sensors: {", "sensors: {" + kPx4SensorList + ", ");
  replace(text, "world: {type: vineyard,",
          "world: {type: vineyard, origin_latitude_deg: 45, origin_longitude_deg: 9, "
          "origin_altitude_m: 150, ");
  return text;
}

}  // namespace vinerow::autopilot_test
