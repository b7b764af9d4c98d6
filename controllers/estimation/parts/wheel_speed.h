#pragma once
/// Speed over ground from the wheels on the left and right sides of a vehicle.

#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/vehicle.h"

namespace vinerow::controllers {

class WheelSpeed {
 public:
  WheelSpeed() = default;
  /// @throws ConfigError if the vehicle has no left or no right wheels, or lacks wheel_radius_m
  /// @param who name of the part for errors, e.g. "rover.estimator (error_state_kalman)"
  WheelSpeed(const VehicleDescription& description, const std::string& who);

  /// Mean rim speed of both sides, m/s; NaN if a side has no reading.
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
