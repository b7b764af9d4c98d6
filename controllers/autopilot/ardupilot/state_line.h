#pragma once
/// Answer of the physics to ArduPilot: one line of JSON.
///
/// ArduPilot 4.6.3 does not parse JSON but searches for words, so the form is fixed: a line feed
/// at both ends, no blanks, "velocity" before "velocity_wind", "rc_1" before "rc_10". A value that
/// is left out keeps its last value there, so every line has the same fields.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace vinerow::controllers {

/// State in ArduPilot's frames: north, east, down (NED) and forward, right, down (FRD).
struct ArdupilotState {
  double timestamp_s = 0.0;
  Eigen::Vector3d gyro_FRD_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_FRD_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d position_NED_m = Eigen::Vector3d::Zero();  ///< from home
  Eigen::Vector3d velocity_NED_mps = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_NED_FRD = Eigen::Quaterniond::Identity();
  std::array<std::optional<double>, 6> ranges_m;  ///< rng_1 to rng_6
  std::optional<double> airspeed_mps;
  std::optional<double> battery_V, battery_A;              ///< both or none
  std::array<std::optional<std::uint16_t>, 12> sticks_us;  ///< rc_1 to rc_12
};

/// Writes lines into its own buffer: no allocation, no locale.
class StateLine {
 public:
  /// @returns the line, valid until the next call; empty if a value is not finite, which would
  /// kill the autopilot (a division trap)
  std::string_view write(const ArdupilotState& state);

 private:
  void text(std::string_view words);
  void number(double value);
  void list(std::string_view key, const double* values, int count);

  std::array<char, 1536> buffer_{};
  std::size_t size_ = 0;
  bool is_finite_ = true;
};

}  // namespace vinerow::controllers
