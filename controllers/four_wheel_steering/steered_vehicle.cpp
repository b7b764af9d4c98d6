#include "controllers/four_wheel_steering/steered_vehicle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow {
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

double positive(const VehicleDescription& description, const char* name, const std::string& who) {
  const double value = description.number(name, who);
  if (value > 0.0) return value;
  throw ConfigError(fmt::format("{}: vehicle type '{}' tells {} = {}, must be > 0", who,
                                description.type, name, value));
}

/// The limit that the actuator has on both sides.
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

SteeredVehicle read_steered_vehicle(const VehicleDescription& description, const std::string& who) {
  demand_actuators(description, who);
  SteeredVehicle vehicle;
  vehicle.geometry.front_m = positive(description, "front_axle_m", who);
  vehicle.geometry.rear_m = positive(description, "rear_axle_m", who);
  vehicle.geometry.track_m = positive(description, "track_m", who);
  vehicle.geometry.wheel_radius_m = positive(description, "wheel_radius_m", who);
  vehicle.steer_rate_radps = positive(description, "steer_rate_radps", who);
  const auto lag = description.numbers.find("steer_lag_s");
  if (lag != description.numbers.end()) vehicle.steer_lag_s = std::max(lag->second, 0.0);
  vehicle.max_axle_rad = positive(description, "max_axle_steer_rad", who);
  for (const char* axle : {kActuators[0], kActuators[1]}) {
    vehicle.max_axle_rad = std::min(vehicle.max_axle_rad, actuator_limit(description, axle, who));
  }
  double wheel_radps = positive(description, "wheel_speed_limit_radps", who);
  for (int i = 2; i < 6; ++i) {
    wheel_radps = std::min(wheel_radps, actuator_limit(description, kActuators[i], who));
  }
  vehicle.rim_max_mps = wheel_radps * vehicle.geometry.wheel_radius_m;
  // Past 60 deg the inner wheel of any usual track stands across.
  constexpr double kLargest_rad = 1.05;
  if (vehicle.max_axle_rad <= 0.0 || vehicle.max_axle_rad > kLargest_rad ||
      vehicle.rim_max_mps <= 0.0) {
    throw ConfigError(
        fmt::format("{}: vehicle type '{}' has axles that turn by {} rad and wheels that turn at "
                    "{} rad/s, must "
                    "be > 0 and the first <= {} rad",
                    who, description.type, vehicle.max_axle_rad, wheel_radps, kLargest_rad));
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
  const double most = rate_radps_ * dt_s;
  const auto turn = [&](double from_rad, double to_rad) {
    return from_rad + std::clamp(share * (to_rad - from_rad), -most, most);
  };
  return {turn(actual_.front_rad, wanted_.front_rad), turn(actual_.rear_rad, wanted_.rear_rad)};
}

}  // namespace vinerow
