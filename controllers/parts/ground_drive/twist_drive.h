#pragma once
/// Actuators of a ground vehicle for a wanted speed and yaw rate, for any kind of steering.

#include <memory>
#include <string>

#include "engine/api/messages/commands.h"
#include "engine/api/vehicle.h"

namespace vinerow::controllers {

class TwistDrive {
 public:
  virtual ~TwistDrive() = default;

  virtual NamedValues make_actuators() const = 0;
  /// Fills `actuators` (names and size as made by make_actuators()). Wheel speeds are not limited.
  virtual void mix(const VelocityCommand& command, NamedValues& actuators) const = 0;
  /// The nearest command that the vehicle can drive: no wheel beyond its speed, no axle beyond its
  /// angle. Wheel speeds scale the command, so that its curvature stays.
  virtual VelocityCommand limit(const VelocityCommand& command) const = 0;
  virtual bool turns_on_the_spot() const = 0;
};

/// Drive by wheel speeds (differential_drive.h) or by the front axle (ackermann_drive.h).
/// @param who  part name in errors, "rover.controller (pure_pursuit)"
/// @throws ConfigError if the vehicle has neither
std::unique_ptr<TwistDrive> make_twist_drive(const VehicleDescription& description,
                                             const std::string& who);

}  // namespace vinerow::controllers
