#include "controllers/estimation/parts/wheel_speed.h"

#include <fmt/format.h>

#include <limits>

#include "controllers/parts/ground_drive/differential_drive.h"
#include "engine/core/error.h"

namespace vinerow::controllers {

WheelSpeed::WheelSpeed(const VehicleDescription& description, const std::string& who)
    : radius_m_(description.need_positive(description.need_wheeled(who).wheel_radius_m,
                                         "wheel_radius_m", who)) {
  int lefts = 0, rights = 0;
  for (const ActuatorSpec& actuator : description.actuators) {
    const double side = side_of_wheel(actuator.name);
    if (side == 0.0) continue;
    wheels_.push_back({actuator.name, side > 0.0, -1});
    ++(side > 0.0 ? rights : lefts);
  }
  if (lefts == 0 || rights == 0) {
    throw ConfigError(
        fmt::format("{}: reads wheel speeds, but vehicle type '{}' has {} left and {} right wheels",
                    who, description.type, lefts, rights));
  }
}

double WheelSpeed::read_mps(const NamedValues& speeds) {
  double left = 0.0, right = 0.0;
  int lefts = 0, rights = 0;
  for (Wheel& wheel : wheels_) {
    if (wheel.index < 0) {
      for (std::size_t i = 0; i < speeds.names.size(); ++i) {
        if (speeds.names[i] == wheel.name) wheel.index = static_cast<int>(i);
      }
    }
    if (wheel.index < 0 || wheel.index >= static_cast<int>(speeds.values.size())) continue;
    (wheel.is_right ? right : left) += speeds.values[wheel.index];
    ++(wheel.is_right ? rights : lefts);
  }
  if (lefts == 0 || rights == 0) return std::numeric_limits<double>::quiet_NaN();
  return 0.5 * radius_m_ * (left / lefts + right / rights);
}

}  // namespace vinerow::controllers
