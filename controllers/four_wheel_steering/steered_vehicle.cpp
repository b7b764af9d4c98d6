#include "controllers/four_wheel_steering/steered_vehicle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow::controllers {
namespace {

constexpr std::array<const char*, 6> kActuators = {"axle_front_steer_rad", "axle_rear_steer_rad",
                                                   "wheel_fl_speed_radps", "wheel_fr_speed_radps",
                                                   "wheel_rl_speed_radps", "wheel_rr_speed_radps"};

void demand_actuators(const VehicleDescription& description, const std::string& who) {
  std::vector<std::string> names;
  for (const ActuatorSpec& actuator : description.actuators) names.push_back(actuator.name);
  for (const char* needed : kActuators) {
    if (std::find(names.begin(), names.end(), needed) != names.end()) continue;
    throw ConfigError(
        fmt::format("{} steers by two axle angles and four wheel speeds (axle_front_steer_rad, "
                    "axle_rear_steer_rad, wheel_fl_speed_radps, ...), but vehicle type '{}' has no "
                    "'{}', only {}",
                    who, description.type, needed, names.empty() ? "none" : join(names)));
  }
}

/// The smaller of the actuator's limits on both sides.
double actuator_limit(const VehicleDescription& description, const char* name,
                      const std::string& who) {
  const ActuatorSpec& spec = description.actuators[description.actuator_index(name, who)];
  return std::min(spec.max, -spec.min);
}

int find(const NamedValues& values, const char* name) {
  const auto it = std::find(values.names.begin(), values.names.end(), name);
  return it == values.names.end() ? -1 : static_cast<int>(it - values.names.begin());
}

}  // namespace

SteeredDrive read_steered_vehicle(const VehicleDescription& description, const std::string& who) {
  demand_actuators(description, who);
  const WheeledVehicle& wheeled = description.need_wheeled(who);
  SteeredDrive vehicle{description.need_steered(who)};
  const auto positive = [&](double value, const char* name) {
    return description.need_positive(value, name, who);
  };
  vehicle.geometry = {
      positive(vehicle.front_axle_m, "front_axle_m"), positive(vehicle.rear_axle_m, "rear_axle_m"),
      positive(wheeled.track_m, "track_m"), positive(wheeled.wheel_radius_m, "wheel_radius_m")};
  positive(vehicle.steer_rate_radps, "steer_rate_radps");
  vehicle.steer_lag_s = std::max(vehicle.steer_lag_s, 0.0);
  positive(vehicle.max_axle_steer_rad, "max_axle_steer_rad");
  for (const char* axle : {kActuators[0], kActuators[1]}) {
    vehicle.max_axle_steer_rad =
        std::min(vehicle.max_axle_steer_rad, actuator_limit(description, axle, who));
  }
  double wheel_radps = positive(wheeled.wheel_speed_limit_radps, "wheel_speed_limit_radps");
  for (int i = 2; i < 6; ++i) {
    wheel_radps = std::min(wheel_radps, actuator_limit(description, kActuators[i], who));
  }
  vehicle.rim_max_mps = wheel_radps * wheeled.wheel_radius_m;
  // Beyond 60 deg the inner wheel of any usual track is across the direction of travel.
  constexpr double kLargest_rad = 1.05;
  if (vehicle.max_axle_steer_rad <= 0.0 || vehicle.max_axle_steer_rad > kLargest_rad ||
      vehicle.rim_max_mps <= 0.0) {
    throw ConfigError(
        fmt::format("{}: vehicle type '{}' has axles that turn by {} rad and wheels that turn at "
                    "{} rad/s, must "
                    "be > 0 and the first <= {} rad",
                    who, description.type, vehicle.max_axle_steer_rad, wheel_radps, kLargest_rad));
  }
  return vehicle;
}

NamedValues make_steered_actuators() {
  NamedValues actuators;
  actuators.names.assign(kActuators.begin(), kActuators.end());
  actuators.values.assign(kActuators.size(), 0.0);
  return actuators;
}

void AxleState::advance(double dt_s) {
  actual_ = predict(dt_s);
}

void AxleState::measure(const NamedValues& encoders) {
  // Names are fixed once the writer is connected.
  if (front_ < 0) front_ = find(encoders, kActuators[0]);
  if (rear_ < 0) rear_ = find(encoders, kActuators[1]);
  const int count = static_cast<int>(encoders.values.size());
  if (front_ >= 0 && front_ < count) actual_.front_rad = encoders.values[front_];
  if (rear_ >= 0 && rear_ < count) actual_.rear_rad = encoders.values[rear_];
}

AxleAngles AxleState::predict(double dt_s) const {
  const double share = lag_s_ > 0.0 ? 1.0 - std::exp(-dt_s / lag_s_) : 1.0;
  const double max_step_rad = rate_radps_ * dt_s;
  const auto turn = [&](double from_rad, double to_rad) {
    return from_rad + std::clamp(share * (to_rad - from_rad), -max_step_rad, max_step_rad);
  };
  return {turn(actual_.front_rad, wanted_.front_rad), turn(actual_.rear_rad, wanted_.rear_rad)};
}

}  // namespace vinerow::controllers
