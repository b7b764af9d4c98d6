#pragma once
/// What every controller of a vehicle on wings reads and writes: "estimate" and "reference"
/// (AirReference) in; "actuators" (throttle, elevons), "deviation" (NamedValues) and "follower"
/// out.
///
/// The reference's steady flight (airspeed, climb angle, bank) has a trim, to which the roll rate
/// of a changing bank and its aileron are added; controllers work on what differs from it: x_lon =
/// [u w q theta h], x_lat = [v p r phi psi] (aircraft_linear.h), where the velocities are against
/// the mean wind that the reference tells, h is the height above the reference's and psi the
/// heading clockwise from it, in (-pi, pi]. Controls are the trim's plus the deviation that the
/// controller asks for.

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
  /// @param limits  what "deviation" is judged by
  AircraftPorts(const ControllerContext& context, const std::string& type,
                const AircraftLimits& limits);

  void connect(Ports& ports);

  const Aircraft& aircraft() const { return aircraft_; }
  const TrimTables& trims() const { return trims_; }
  bool has_estimate() const { return estimate_.has_value(); }
  bool has_reference() const { return reference_.has_value(); }
  const Odometry& estimate() const { return estimate_.value(); }
  const AirReference& reference() const { return reference_.value(); }
  /// The reference wants it in the air, under power or gliding; also when it is done, with power.
  bool is_flying() const;
  /// Actuators have been written since the reference is done: off, or flying on where it wants.
  bool has_ended() const { return has_ended_; }

  /// The reference wants it launched and it is still slower than 0.8 of the wanted airspeed.
  /// As of the last take_over().
  bool is_launching() const { return is_launching_; }

  /// Takes over estimate and reference. Where a number of them is not finite there is no deviation:
  /// the controls stay at the trim's. @pre both are there
  void take_over();
  /// As of the last take_over().
  const AircraftDeviation& deviation() const { return deviation_; }
  const TrimPoint& trim() const { return trim_; }

  /// Trim plus deviation of the controls, limited to what the actuators can do, then written; the
  /// throttle is 0 where the reference's `power` is off, and no throttle is counted then.
  /// A deviation that is not finite counts as none. No heap.
  /// @returns the deviations that were left after limiting
  AircraftControls write(Time now, const AircraftControls& deviation);
  /// Full throttle, trimmed elevator, no aileron; nothing counts as a deviation beyond its limit.
  void write_launch(Time now);
  /// Propeller off, elevons neutral; no deviations.
  void write_off(Time now);

 private:
  /// The reference's bank changes: its roll rate belongs to the steady flight, and so does the
  /// aileron that keeps it up.
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
  double aileron_per_roll_rate_s_ = 0.0;  // that keeps a roll rate against the wing's damping
  double bank_before_rad_ = 0.0;          // of the reference; NaN: none yet
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
