#include "python/tasks/skid_drive.h"

#include <fmt/format.h>

#include <string_view>

#include "engine/core/error.h"

namespace vinerow::tasks {

SkidDrive::SkidDrive(std::string signal, const VehicleDescription& vehicle, const std::string& who)
    : signal_(std::move(signal)) {
  const WheeledVehicle& wheeled = vehicle.need_wheeled(who);
  if (vehicle.steers_by_axles()) {
    throw ConfigError(fmt::format(
        "{} needs a vehicle that steers by wheel speeds; vehicle type '{}' steers by its axles",
        who, vehicle.type));
  }
  half_track_m_ =
      0.5 * (wheeled.effective_track_m > 0.0 ? wheeled.effective_track_m : wheeled.track_m);
  radius_m_ = wheeled.wheel_radius_m;
  // "wheel_fl_speed_radps": the last letter of the place is the side.
  constexpr std::string_view kPrefix = "wheel_";
  for (const ActuatorSpec& actuator : vehicle.actuators) {
    const std::size_t end = actuator.name.find('_', kPrefix.size());
    if (!actuator.name.starts_with(kPrefix) || end == std::string::npos) continue;
    wheels_.names.push_back(actuator.name);
    sides_.push_back(actuator.name[end - 1] == 'l' ? -1.0 : 1.0);
  }
  wheels_.values.resize(wheels_.names.size());
}

OutsideCommand SkidDrive::command(Time stamp, double v_mps, double yaw_rate_radps) {
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    wheels_.values[i] = (v_mps + sides_[i] * half_track_m_ * yaw_rate_radps) / radius_m_;
  }
  return outside_command<NamedValues>(signal_, stamp, wheels_);
}

}  // namespace vinerow::tasks
