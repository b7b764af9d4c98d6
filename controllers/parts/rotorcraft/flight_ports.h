#pragma once
/// Signals of every rotorcraft controller: reads "estimate" and "reference", writes "actuators"
/// (rotor speeds), "wrench" (NamedValues: wanted and reachable thrust and torques) and "follower".

#include <optional>
#include <vector>

#include "controllers/parts/rotorcraft/lay_down.h"
#include "controllers/parts/rotorcraft/rotor_mixer.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/flight.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

class FlightPorts {
 public:
  /// @throws ConfigError if the vehicle has no rotors
  FlightPorts(const ControllerContext& context, const std::string& type);

  void connect(Ports& ports);

  const RotorcraftModel& craft() const { return craft_; }
  RotorMixer& mixer() { return mixer_; }
  bool has_estimate() const { return estimate_.has_value(); }
  const Odometry& estimate() const { return estimate_.value(); }
  bool has_reference() const {
    return reference_.has_value() && !reference_.value().points.empty();
  }
  const ReferenceTrajectory& reference() const { return reference_.value(); }
  /// The reference wants turning rotors (neither waiting nor done), or they wind down after a
  /// flight: see write().
  bool is_flying() const;
  bool is_done() const {
    return has_reference() && reference().phase == ReferenceTrajectory::Phase::kDone;
  }
  /// Rotors off have been written since the reference ended: the controller has finished.
  bool has_ended() const { return has_ended_; }

  /// The reference at a time between its points: position by cubic Hermite interpolation, the rest
  /// linear. After the last point it stays there, at rest. @pre has_reference()
  TrajectoryPoint reference_at(Time now) const;
  /// False until a take-off leaves the ground: before that, integrators and observers would learn
  /// the force of the ground. As of the last write().
  bool has_lifted_off() const { return has_lifted_off_; }

  /// Mixes and writes. Once the reference is done, the vehicle is laid down (lay_down.h) whatever
  /// the wanted wrench, and kWindDown_s later the rotors are off. No heap.
  /// @returns the wrench that the rotors reach
  Wrench write(Time now, const Wrench& wanted);
  /// The rotor speeds written last, rad/s.
  const std::vector<double>& speeds_radps() const { return actuator_values_.values; }
  /// Rotors off.
  void write_off(Time now);

 private:
  static constexpr double kWindDown_s = 3.0;

  Wrench lay_down(Time now);
  void write_values(Time now, const Wrench& wanted, const Wrench& reached);
  void write_follower(Time now);

  RotorcraftModel craft_;
  RotorMixer mixer_;
  bool has_ended_ = false;
  bool has_lifted_off_ = false;
  bool has_flown_ = false;  // since the rotors were off
  std::optional<Time> landed_;
  Time laid_;  // as of the last tick of lay_down_
  LayDown lay_down_;
  NamedValues actuator_values_;
  NamedValues wrench_values_;
  SignalReader<Odometry> estimate_;
  SignalReader<ReferenceTrajectory> reference_;
  SignalWriter<NamedValues> actuators_;
  SignalWriter<NamedValues> wrench_;
  SignalWriter<FollowerState> follower_;
};

}  // namespace vinerow::controllers
