#pragma once
/// Flies the plain quadrotor of quadrotor_sim.h under a registered controller, with signals and
/// rates as in a run, but without kernel and physics. The reference comes from a function of time
/// or from a registered guidance.

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/flight.h"
#include "engine/api/registry.h"
#include "tests/controllers/support/mission.h"
#include "tests/controllers/support/quadrotor_sim.h"

namespace vinerow::test {

using Phase = ReferenceTrajectory::Phase;

/// Where to be at a time, with consistent velocity and acceleration.
using FlightPath = std::function<TrajectoryPoint(double time_s)>;

/// Holds a place.
FlightPath hover_at(const Eigen::Vector3d& p_W, double yaw_rad = 0.0);
/// From p_W along yaw_rad: speeds up at 1.5 m/s2, then a straight at speed_mps; after
/// straight_m an arc to the left of this radius (0: none) as far as turn_rad, then straight on.
/// Curvature sets in over ramp_m.
FlightPath row_and_turn(const Eigen::Vector3d& p_W, double yaw_rad, double speed_mps,
                        double straight_m, double radius_m = 0.0, double turn_rad = 0.0);

struct FlightSetup {
  QuadrotorNumbers numbers = make_q4t();
  std::optional<QuadrotorNumbers> told;  ///< what the controller is told; default: the truth
  PartChoice controller{"quadrotor_pid", {}};
  double rate_Hz = 0.0;  ///< of the controller; 0: its own
  FlightPath path = hover_at({0, 0, 2});
  std::function<Phase(double time_s)> phase;  ///< default: kHover
  /// Instead of path and phase: a guidance and the plan it gets.
  PartChoice guidance{"", {}};
  PlannedPath plan;
  double guidance_rate_Hz = 20.0;
  int points = 21;  ///< of the reference
  double dt_s = 0.05;
  /// Where the movement authority ends at a time, along the plan; default: there is none.
  std::function<double(double time_s)> stop_at_m;
  WindField wind;
  Pose start;  ///< used with rotors_on: in hover there
  bool rotors_on = true;
  double floor_m = -1e9;
};

class FlightLoop {
 public:
  explicit FlightLoop(const FlightSetup& setup);
  FlightLoop(const FlightLoop&) = delete;

  /// Physics steps of 1 ms until this time; parts at their own rates.
  void run_until(double time_s, const std::function<void(const FlightLoop&)>& each_step = {});

  const QuadrotorSim& sim() const { return sim_; }
  QuadrotorSim& sim() { return sim_; }
  double time_s() const { return static_cast<double>(now_.ns) * 1e-9; }
  const Controller& controller() const { return *controller_; }
  const NamedValues& actuators() const { return actuators_.value(); }
  const NamedValues& wrench() const { return wrench_.value(); }
  const FollowerState& follower() const { return follower_.value(); }
  const ReferenceTrajectory& reference() const { return reference_in_.value(); }
  /// From the path of the setup at this moment to the vehicle: x along the path's yaw, y left.
  Eigen::Vector3d error_in_yaw_frame() const;
  /// One tick of the controller alone, at the present time.
  void tick_controller() { controller_->step(now_); }

 private:
  void write_reference();

  FlightSetup setup_;
  VehicleDescription description_;
  QuadrotorSim sim_;
  SignalBus bus_;
  std::unique_ptr<Guidance> guidance_;
  std::unique_ptr<Controller> controller_;
  SignalWriter<Odometry> estimate_;
  SignalWriter<ReferenceTrajectory> reference_out_;
  SignalWriter<MovementAuthority> authority_;
  SignalReader<ReferenceTrajectory> reference_in_;
  SignalReader<NamedValues> actuators_, wrench_;
  SignalReader<FollowerState> follower_;
  ReferenceTrajectory trajectory_;
  Time now_;
  Duration control_period_, guidance_period_;
};

/// A mean wind and a bounded random gust along both horizontal directions: first-order noise of
/// sigma gust / 2 cut at the gust, correlated over correlation_s. Made beforehand, so that every
/// controller meets the same.
WindField gusty_wind(const Eigen::Vector3d& mean_W, double gust_mps, double correlation_s,
                     double longest_s, std::uint64_t seed);

}  // namespace vinerow::test
