#include "controllers/parts/ground_drive/ackermann_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow::controllers {

AckermannDrive::AckermannDrive(const VehicleDescription& description, const std::string& who) {
  const WheeledVehicle& wheeled = description.need_wheeled(who);
  const AckermannVehicle& ackermann = description.need_ackermann(who);
  wheel_base_m_ = description.need_positive(wheeled.wheel_base_m, "wheel_base_m", who);
  wheel_radius_m_ = description.need_positive(wheeled.wheel_radius_m, "wheel_radius_m", who);
  const double half_m = 0.5 * description.need_positive(wheeled.track_m, "track_m", who);
  const double max_rad =
      description.need_positive(ackermann.max_axle_steer_rad, "max_axle_steer_rad", who);
  max_curvature_per_m_ = std::tan(max_rad) / wheel_base_m_;

  const std::map<std::string, Eigen::Vector2d> places = {
      {"wheel_fl_speed_radps", {wheel_base_m_, half_m}},
      {"wheel_fr_speed_radps", {wheel_base_m_, -half_m}},
      {"wheel_rl_speed_radps", {0.0, half_m}},
      {"wheel_rr_speed_radps", {0.0, -half_m}}};
  std::vector<std::string> names;
  bool fits = true;
  int axles = 0;
  for (const ActuatorSpec& actuator : description.actuators) {
    names.push_back(actuator.name);
    if (actuator.name == "axle_front_steer_rad") {
      actuators_.push_back({actuator.name, false, {0.0, 0.0}, 0.0});
      ++axles;
    } else if (const auto place = places.find(actuator.name); place != places.end()) {
      actuators_.push_back(
          {actuator.name, true, place->second, std::min(actuator.max, -actuator.min)});
    } else {
      fits = false;
    }
  }
  if (fits && axles == 1 && actuators_.size() > 1) return;
  throw ConfigError(
      fmt::format("{} steers by a front axle and drives wheels fl, fr, rl, rr "
                  "(axle_front_steer_rad, wheel_rl_speed_radps, ...), but vehicle type '{}' has "
                  "the actuators {}",
                  who, description.type, names.empty() ? "none" : join(names)));
}

NamedValues AckermannDrive::make_actuators() const {
  NamedValues values;
  for (const Actuator& actuator : actuators_) values.names.push_back(actuator.name);
  values.values.assign(actuators_.size(), 0.0);
  return values;
}

double AckermannDrive::rim_per_speed(const Actuator& wheel, double curvature_per_m) {
  const double along = 1.0 - curvature_per_m * wheel.p_R.y();
  const double across = curvature_per_m * wheel.p_R.x();
  // In a turn about a point between the rear wheels the inner wheel rolls backwards.
  return across == 0.0 ? along : std::copysign(std::hypot(along, across), along);
}

double AckermannDrive::curvature_of(const VelocityCommand& command) const {
  return std::clamp(command.yaw_rate_radps / command.v_mps, -max_curvature_per_m_,
                    max_curvature_per_m_);
}

void AckermannDrive::mix(const VelocityCommand& command, NamedValues& actuators) const {
  const bool stands = command.v_mps == 0.0;
  const double curvature_per_m = stands ? 0.0 : curvature_of(command);
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    const Actuator& actuator = actuators_[i];
    if (actuator.is_wheel) {
      actuators.values[i] =
          command.v_mps * rim_per_speed(actuator, curvature_per_m) / wheel_radius_m_;
    } else if (!stands) {
      actuators.values[i] = std::atan(curvature_per_m * wheel_base_m_);
    }
  }
}

VelocityCommand AckermannDrive::limit(const VelocityCommand& command) const {
  if (command.v_mps == 0.0) return {0.0, 0.0};
  const double curvature_per_m = curvature_of(command);
  double v_mps = command.v_mps;
  for (const Actuator& actuator : actuators_) {
    if (!actuator.is_wheel) continue;
    const double per_speed = std::abs(rim_per_speed(actuator, curvature_per_m));
    const double max_mps = actuator.max_radps * wheel_radius_m_;
    if (std::abs(v_mps) * per_speed > max_mps) v_mps = std::copysign(max_mps / per_speed, v_mps);
  }
  return {v_mps, v_mps * curvature_per_m};
}

}  // namespace vinerow::controllers
