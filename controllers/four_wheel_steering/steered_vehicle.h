#pragma once
/// Model of a vehicle with two steered axles and four driven wheels, for its controller.

#include <string>

#include "controllers/four_wheel_steering/axle_geometry.h"
#include "engine/api/messages/commands.h"
#include "engine/api/vehicle.h"

namespace vinerow::controllers {

/// The vehicle's record, extended by the data that driving needs; max_axle_steer_rad is clamped to
/// the range of both axles' actuators.
struct SteeredDrive : SteeredVehicle {
  AxleGeometry geometry{};   ///< from the records of wheels and axles, for the formulas
  double rim_max_mps = 0.0;  ///< wheel speed limit times wheel radius

  /// Time to swing the axles from one limit to the other.
  double swing_s() const { return 2.0 * max_axle_steer_rad / steer_rate_radps; }
};

/// @param who  part name in errors, e.g. "rover.controller (four_wheel_steering)"
/// @throws ConfigError if an actuator or a record is missing or a number of it is not positive
SteeredDrive read_steered_vehicle(const VehicleDescription& description, const std::string& who);

/// The six actuators by name, all zero: front axle, rear axle, wheels fl, fr, rl, rr.
NamedValues make_steered_actuators();

/// Angles of both axles over time: measured if an encoder provides them, else those of a servo with
/// the vehicle's lag and rate limit.
class AxleState {
 public:
  explicit AxleState(const SteeredDrive& vehicle)
      : rate_radps_(vehicle.steer_rate_radps), lag_s_(vehicle.steer_lag_s) {}

  /// Advances the model by the cycle that ends now, turning towards the last command.
  void advance(double dt_s);
  /// Takes over measured angles. Ignored if the encoders lack the two axles.
  void measure(const NamedValues& encoders);
  void command(const AxleAngles& wanted) { wanted_ = wanted; }

  const AxleAngles& actual() const { return actual_; }
  const AxleAngles& wanted() const { return wanted_; }
  /// Predicted angles after a time, turning towards the command.
  AxleAngles predict(double dt_s) const;

 private:
  double rate_radps_, lag_s_;
  AxleAngles actual_, wanted_;
  int front_ = -1, rear_ = -1;  ///< indices in the encoders' values
};

}  // namespace vinerow::controllers
