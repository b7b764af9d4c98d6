#include "controllers/autopilot/firmware/sensor_mounting.h"

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

/// @returns nullptr if the vehicle has no such sensor, or it is not mounted
const SensorMounting* find_mounting(const std::string& sensor,
                                    const std::vector<SensorMounting>& mountings) {
  const auto mounting = std::find_if(mountings.begin(), mountings.end(),
                                     [&](const auto& other) { return other.name == sensor; });
  return mounting != mountings.end() ? &*mounting : nullptr;
}

}  // namespace

std::optional<std::uint8_t> range_orientation(const std::string& sensor,
                                              const std::vector<SensorMounting>& mountings) {
  const SensorMounting* mounting = find_mounting(sensor, mountings);
  if (mounting == nullptr) return std::nullopt;
  const Eigen::Vector3d x_B = mounting->X_BS.q * Eigen::Vector3d::UnitX();
  constexpr std::uint8_t kUp = 24, kDown = 25;
  if (std::abs(x_B.z()) >= std::sqrt(0.5)) return x_B.z() > 0.0 ? kUp : kDown;
  const double right_deg = deg_from_rad(std::atan2(-x_B.y(), x_B.x()));
  return static_cast<std::uint8_t>((static_cast<int>(std::lround(right_deg / 45.0)) + 8) % 8);
}

Eigen::Quaterniond q_BS_of(const std::string& sensor,
                           const std::vector<SensorMounting>& mountings) {
  const SensorMounting* mounting = find_mounting(sensor, mountings);
  return mounting != nullptr ? mounting->X_BS.q : Eigen::Quaterniond::Identity();
}

}  // namespace vinerow::controllers
