#pragma once
/// The controller quadrotor_mpc on the plain quadrotor of quadrotor_sim.h, without kernel and
/// registry: what it writes, what it tells, and how far off it flies.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/flight.h"
#include "engine/api/parameters.h"
#include "engine/api/stepped_parts.h"
#include "tests/controllers/quadrotor_mpc/mpc_path.h"
#include "tests/controllers/support/quadrotor_sim.h"

namespace vinerow::test {

using Values = std::vector<std::pair<std::string, ParameterSet::Value>>;
using Phase = ReferenceTrajectory::Phase;

struct MpcSetup {
  Values parameters;
  QuadrotorNumbers numbers = make_q4t();  ///< of the vehicle that flies
  QuadrotorNumbers told = make_q4t();     ///< what the controller is told of it
  double rate_Hz = 20.0;
  double guidance_rate_Hz = 20.0;
  int points = 21;  ///< of the reference, 0.05 s apart
  TimedPath path;
  Phase phase = Phase::kHover;
  double physics_s = 0.001;
};

/// @throws ConfigError as the controller does
std::unique_ptr<Controller> make_mpc(const Values& parameters,
                                     const VehicleDescription& description, double rate_Hz = 20.0);

class MpcLoop {
 public:
  /// The vehicle hovers where the path begins, with its speed.
  explicit MpcLoop(const MpcSetup& setup);
  MpcLoop(const MpcLoop&) = delete;

  /// One period of the controller: it decides, the vehicle flies.
  void tick() {
    tick([](const std::function<void()>& decide) { decide(); });
  }
  /// The same; `around` is to call what it is given, which is the controller's step.
  void tick(const std::function<void(const std::function<void()>& decide)>& around);
  void run_until(double time_s);

  double time_s() const { return static_cast<double>(now_.ns) * 1e-9; }
  QuadrotorSim& sim() { return sim_; }
  const Controller& controller() const { return *controller_; }
  void set_phase(Phase phase) { setup_.phase = phase; }
  void set_path(TimedPath path) { setup_.path = std::move(path); }
  /// The estimate is the truth; this is added to it.
  void set_estimate_noise(std::function<void(Odometry&)> noise) { noise_ = std::move(noise); }
  /// A torque that nobody tells the controller of, N m in B.
  void set_torque_bias(const Eigen::Vector3d& torque_B) { bias_B_ = torque_B; }

  /// Off the path, along its heading, to its left, up.
  Eigen::Vector3d error() const;
  double forward_speed_error() const;
  const std::vector<double>& rotors() const { return actuators_.value().values; }
  double mpc(const std::string& name) const { return value_of(mpc_.value(), name); }
  double wrench(const std::string& name) const { return value_of(wrench_.value(), name); }
  const std::vector<std::string>& events() const { return events_; }

 private:
  static double value_of(const NamedValues& values, const std::string& name);
  void write_reference();

  MpcSetup setup_;
  VehicleDescription description_;
  QuadrotorSim sim_;
  SignalBus bus_;
  std::unique_ptr<Controller> controller_;
  SignalWriter<Odometry> estimate_;
  SignalWriter<ReferenceTrajectory> reference_;
  SignalReader<NamedValues> actuators_, wrench_, mpc_;
  SignalReader<Event> event_;
  ReferenceTrajectory trajectory_;
  std::function<void(Odometry&)> noise_;
  Eigen::Vector3d bias_B_ = Eigen::Vector3d::Zero();
  std::vector<std::string> events_;
  std::uint64_t seen_event_ = 0;
  Time now_;
  Duration period_, guidance_period_;
};

/// Errors of a flight along a path, from `from_s` to `to_s`.
struct FlightErrors {
  double lateral_rms_m = 0.0, lateral_max_m = 0.0;   ///< in rows
  double turn_lateral_max_m = 0.0;                   ///< in the turn
  double altitude_max_m = 0.0, speed_max_mps = 0.0;  ///< speed: in rows
  double along_max_m = 0.0, tilt_max_rad = 0.0;
  bool finite = true;
};
/// Flies to the end of the path's time and judges at each tick of the controller.
FlightErrors fly(MpcLoop& loop, const RowsAndTurn& rows, double from_s);

}  // namespace vinerow::test
