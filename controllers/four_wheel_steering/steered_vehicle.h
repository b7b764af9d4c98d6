#pragma once
/// What the controller knows of a vehicle with two steered axles and four driven wheels.

#include <string>

#include "controllers/four_wheel_steering/axle_geometry.h"
#include "engine/api/messages/commands.h"
#include "engine/api/vehicle.h"

namespace vinerow::controllers {

/// The vehicle's record with what driving it takes besides; max_axle_steer_rad is cut to the range
/// of both axles' actuators.
struct SteeredDrive : SteeredVehicle {
  AxleGeometry geometry{};   ///< of the wheels' and the axles' records, for the formulas
  double rim_max_mps = 0.0;  ///< wheel speed limit times wheel radius

  /// Time to swing the axles from one limit to the other.
  double swing_s() const { return 2.0 * max_axle_steer_rad / steer_rate_radps; }
};

/// @param who  part that asks, e.g. "rover.controller (four_wheel_steering)"
/// @throws ConfigError if an actuator or a record is missing or a number of it is not positive
SteeredDrive read_steered_vehicle(const VehicleDescription& description, const std::string& who);

/// The six actuators by name, all zero: front axle, rear axle, wheels fl, fr, rl, rr.
NamedValues make_steered_actuators();

/// The angles of both axles over time: measured where an encoder tells them, else those of a servo
/// with the vehicle's lag and rate limit.
class AxleState {
 public:
  explicit AxleState(const SteeredDrive& vehicle)
      : rate_radps_(vehicle.steer_rate_radps), lag_s_(vehicle.steer_lag_s) {}

  /// The cycle that ends now was spent turning towards the last command.
  void advance(double dt_s);
  /// Takes over measured angles. Encoders without the two axles change nothing.
  void measure(const NamedValues& encoders);
  void command(const AxleAngles& wanted) { wanted_ = wanted; }

  const AxleAngles& actual() const { return actual_; }
  const AxleAngles& wanted() const { return wanted_; }
  /// Where the steering will be after a time, turning towards the command.
  AxleAngles predict(double dt_s) const;

 private:
  double rate_radps_, lag_s_;
  AxleAngles actual_, wanted_;
  int front_ = -1, rear_ = -1;  ///< places in the encoders' values
};

}  // namespace vinerow::controllers
