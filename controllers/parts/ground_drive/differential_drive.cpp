#include "controllers/parts/ground_drive/differential_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow::controllers {

double side_of_wheel(const std::string& actuator) {
  constexpr std::string_view kPrefix = "wheel_", kSuffix = "_speed_radps";
  std::string_view place = actuator;
  if (!place.starts_with(kPrefix) || !place.ends_with(kSuffix)) return 0.0;
  place.remove_prefix(kPrefix.size());
  if (place.size() <= kSuffix.size()) return 0.0;
  place.remove_suffix(kSuffix.size());
  if (place.ends_with("left")) return -1.0;
  if (place.ends_with("right")) return 1.0;
  // Short places: l, fl, ml, rl and r, fr, mr, rr.
  if (place.size() > 2) return 0.0;
  if (place.ends_with('l')) return -1.0;
  return place.ends_with('r') ? 1.0 : 0.0;
}

DifferentialDrive::DifferentialDrive(const VehicleDescription& description,
                                     const std::string& who) {
  bool has_left = false, has_right = false, has_other = false;
  std::vector<std::string> names;
  for (const ActuatorSpec& actuator : description.actuators) {
    const double side = side_of_wheel(actuator.name);
    has_left = has_left || side < 0.0;
    has_right = has_right || side > 0.0;
    has_other = has_other || side == 0.0;
    names.push_back(actuator.name);
    wheels_.push_back({actuator.name, side, std::min(actuator.max, -actuator.min)});
  }
  if (!has_left || !has_right || has_other) {
    throw ConfigError(
        fmt::format("{} steers by the speeds of left and right wheels (wheel_fl_speed_radps, "
                    "wheel_right_speed_radps, ...), but vehicle type '{}' has the actuators {}",
                    who, description.type, names.empty() ? "none" : join(names)));
  }
  const WheeledVehicle& wheeled = description.need_wheeled(who);
  track_m_ = description.need_positive(wheeled.track_m, "track_m", who);
  wheel_radius_m_ = description.need_positive(wheeled.wheel_radius_m, "wheel_radius_m", who);
}

NamedValues DifferentialDrive::make_actuators() const {
  NamedValues actuators;
  for (const Wheel& wheel : wheels_) actuators.names.push_back(wheel.name);
  actuators.values.assign(wheels_.size(), 0.0);
  return actuators;
}

void DifferentialDrive::mix(const VelocityCommand& command, NamedValues& actuators) const {
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const double rim_mps =
        command.v_mps + wheels_[i].side * command.yaw_rate_radps * 0.5 * track_m_;
    actuators.values[i] = rim_mps / wheel_radius_m_;
  }
}

VelocityCommand DifferentialDrive::limit(const VelocityCommand& command) const {
  double scale = 1.0;
  for (const Wheel& wheel : wheels_) {
    const double rim_mps =
        std::abs(command.v_mps + wheel.side * command.yaw_rate_radps * 0.5 * track_m_);
    const double max_mps = wheel.max_radps * wheel_radius_m_;
    if (rim_mps > max_mps) scale = std::min(scale, max_mps / rim_mps);
  }
  return {command.v_mps * scale, command.yaw_rate_radps * scale};
}

}  // namespace vinerow::controllers
