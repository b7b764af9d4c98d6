#pragma once
/// Wheel speeds of a skid-steered vehicle from speed and yaw rate.

#include "engine/api/messages/commands.h"
#include "engine/api/outside.h"
#include "engine/api/vehicle.h"

namespace vinerow::tasks {

class SkidDrive {
 public:
  SkidDrive() = default;
  /// @param signal  "<vehicle>/actuators"
  /// @throws ConfigError unless the vehicle steers by wheel speeds alone
  SkidDrive(std::string signal, const VehicleDescription& vehicle, const std::string& who);

  /// v_left, v_right = v -+ yaw rate * effective track / 2; wheel speed = v / radius.
  OutsideCommand command(Time stamp, double v_mps, double yaw_rate_radps);

 private:
  std::string signal_;
  NamedValues wheels_;
  std::vector<double> sides_;  ///< -1 left, +1 right
  double half_track_m_ = 0.0;
  double radius_m_ = 0.0;
};

}  // namespace vinerow::tasks
