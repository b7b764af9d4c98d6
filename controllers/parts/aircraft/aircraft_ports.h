#pragma once
/// Signals of every controller of a fixed-wing vehicle: reads "estimate" and "reference"
/// (AirReference), writes "actuators" (throttle, elevons), "deviation" (NamedValues) and
/// "follower".
///
/// The reference's steady flight (airspeed, climb angle, bank) has a trim, to which the roll rate
/// of a changing bank and its aileron are added. Controllers work on the deviation from it: x_lon =
/// [u w q theta h], x_lat = [v p r phi psi] (aircraft_linear.h). Velocities are relative to the
/// mean wind in the reference, h is the height above the reference's and psi the heading clockwise
/// from it, in (-pi, pi]. Controls are those of the trim plus the controller's deviation.

#include <Eigen/Core>

#include "controllers/parts/aircraft/aircraft.h"
#include "controllers/parts/aircraft/aircraft_limits.h"
#include "controllers/parts/aircraft/trim_table.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/flight.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

struct AircraftDeviation {
  Eigen::Matrix<double, 5, 1> lon = Eigen::Matrix<double, 5, 1>::Zero();
  Eigen::Matrix<double, 5, 1> lat = Eigen::Matrix<double, 5, 1>::Zero();
};

class AircraftPorts {
 public:
  /// @throws ConfigError if the vehicle has no wings, or no trim at its cruise speed
  /// @param limits  for the verdict in "deviation"
  AircraftPorts(const ControllerContext& context, const std::string& type,
                const AircraftLimits& limits);

  void connect(Ports& ports);

  const Aircraft& aircraft() const { return aircraft_; }
  const TrimTables& trims() const { return trims_; }
  bool has_estimate() const { return estimate_.has_value(); }
  bool has_reference() const { return reference_.has_value(); }
  const Odometry& estimate() const { return estimate_.value(); }
  const AirReference& reference() const { return reference_.value(); }
  /// The reference wants it in the air, powered or gliding; also after its end while `power` is on.
  bool is_flying() const;
  /// Actuators have been written since the reference ended, off or for further flight.
  bool has_ended() const { return has_ended_; }

  /// The reference wants it launched and it is still slower than 0.8 of the wanted airspeed.
  /// As of the last take_over().
  bool is_launching() const { return is_launching_; }

  /// Takes over estimate and reference. If a number in them is not finite, the deviation is zero
  /// and the controls stay those of the trim. @pre both have a value
  void take_over();
  /// As of the last take_over().
  const AircraftDeviation& deviation() const { return deviation_; }
  const TrimPoint& trim() const { return trim_; }

  /// Trim plus deviation of the controls, limited to the range of the actuators, then written. If
  /// the reference's `power` is off, the throttle is 0 and its deviation is not counted.
  /// A deviation that is not finite counts as zero. No heap.
  /// @returns the deviations that remain after limiting
  AircraftControls write(Time now, const AircraftControls& deviation);
  /// Full throttle, trimmed elevator, no aileron; no deviation counts as beyond its limit.
  void write_launch(Time now);
  /// Propeller off, elevons neutral; no deviations.
  void write_off(Time now);

 private:
  /// Adds the roll rate of the reference's changing bank to the steady flight, and the aileron that
  /// maintains it.
  void add_roll_rate(double bank_rad);
  void write_actuators(Time now, const AircraftControls& controls);
  void write_deviation(Time now, const AircraftDeviation& deviation,
                       const AircraftControls& controls, bool judged);
  void write_follower(Time now);

  Aircraft aircraft_;
  TrimTables trims_;
  AircraftLimits limits_;
  AircraftDeviation deviation_;
  TrimPoint trim_;
  double period_s_ = 0.0;
  double aileron_per_roll_rate_s_ = 0.0;  // maintains a roll rate against the wing's damping
  double bank_before_rad_ = 0.0;          // of the reference; NaN before the first
  bool has_ended_ = false;
  bool is_launching_ = false;
  NamedValues actuator_values_;
  NamedValues deviation_values_;
  SignalReader<Odometry> estimate_;
  SignalReader<AirReference> reference_;
  SignalWriter<NamedValues> actuators_;
  SignalWriter<NamedValues> deviation_out_;
  SignalWriter<FollowerState> follower_;
};

}  // namespace vinerow::controllers
