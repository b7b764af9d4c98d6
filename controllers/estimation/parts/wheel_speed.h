#pragma once
/// Speed over ground as the wheels of the vehicle's left and right sides tell it.

#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/vehicle.h"

namespace vinerow::controllers {

class WheelSpeed {
 public:
  WheelSpeed() = default;
  /// @throws ConfigError if the vehicle has no left or no right wheels, or tells no wheel_radius_m
  /// @param who  part that asks, e.g. "rover.estimator (error_state_kalman)"
  WheelSpeed(const VehicleDescription& description, const std::string& who);

  /// Mean rim speed of both sides, m/s; NaN where a side says nothing.
  double read_mps(const NamedValues& speeds);

 private:
  struct Wheel {
    std::string name;
    bool is_right = false;
    int index = -1;
  };
  double radius_m_ = 0.0;
  std::vector<Wheel> wheels_;
};

}  // namespace vinerow::controllers
