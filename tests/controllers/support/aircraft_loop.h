#pragma once
/// Flies the plain aircraft of aircraft_sim.h under a registered controller, with signals and rates
/// as in a run, but without kernel and physics. The reference is a function of time.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/flight.h"
#include "engine/api/registry.h"
#include "tests/controllers/support/aircraft_sim.h"
#include "tests/controllers/support/mission.h"

namespace vinerow::test {

using AirPhase = AirReference::Phase;
using AirCourse = std::function<AirReference(double time_s)>;

/// Straight ahead at 12 m/s. @param course_rad  from east to the left
AirCourse fly_straight(double course_rad, double height_m, double climb_angle_rad = 0.0);
/// A circle at a bank, in a steady climb.
AirCourse fly_circle(double course_rad, double height_m, double bank_rad,
                     double climb_angle_rad = 0.0);
/// Lanes of 260 m with a U-turn between them, to the right and to the left by turns, each turn two
/// corners of 90 deg with 24 m between them; heights of ramps with kinks. The reference's own bank
/// is at most `bank_rad`, with 60 deg/s and a lag of 0.45 s (reference of paper A, section 2).
AirCourse fly_lanes(int lanes, double bank_rad = 35.0 * M_PI / 180.0);

struct AircraftLoopSetup {
  AircraftNumbers numbers;
  std::optional<AircraftNumbers> told;  ///< what the controller is told; default: the truth
  PartChoice controller{"fixed_wing_pid", {}};
  double rate_Hz = 0.0;  ///< of the controller; 0: its own
  AirCourse reference = fly_straight(0.0, 100.0);
  WindField wind;
  /// From where the reference is in steady flight, angles of aviation.
  double higher_m = 0.0, faster_mps = 0.0, roll_rad = 0.0, pitch_rad = 0.0, turned_rad = 0.0;
};

class AircraftLoop {
 public:
  explicit AircraftLoop(const AircraftLoopSetup& setup);
  AircraftLoop(const AircraftLoop&) = delete;

  /// Steps of 5 ms until this time; the controller at its own rate.
  void run_until(double time_s, const std::function<void(const AircraftLoop&)>& each_tick = {});

  const AircraftSim& sim() const { return sim_; }
  AircraftSim& sim() { return sim_; }
  double time_s() const { return static_cast<double>(now_.ns) * 1e-9; }
  const Controller& controller() const { return *controller_; }
  const NamedValues& actuators() const { return actuators_.value(); }
  /// An entry of "deviation" by its name.
  double deviation(const std::string& name) const;
  const FollowerState& follower() const { return follower_.value(); }
  const AirReference& reference() const { return reference_in_.value(); }
  /// One tick of the controller alone, at the present time.
  void tick_controller() { controller_->step(now_); }
  /// Instead of the truth, from now on.
  void set_estimate(std::optional<Odometry> estimate) { estimate_instead_ = estimate; }

 private:
  AircraftLoopSetup setup_;
  VehicleDescription description_;
  AircraftSim sim_;
  SignalBus bus_;
  std::unique_ptr<Controller> controller_;
  SignalWriter<Odometry> estimate_;
  SignalWriter<AirReference> reference_out_;
  SignalReader<AirReference> reference_in_;
  SignalReader<NamedValues> actuators_, deviation_;
  SignalReader<FollowerState> follower_;
  std::optional<Odometry> estimate_instead_;
  Time now_;
  Duration control_period_;
};

/// Mean wind and, along the fixed direction `along_rad` from east, a Gauss-Markov gust of sigma
/// bound / 2 with a length of 60 m at 12 m/s, cut at the bound (reference of paper A, section 1).
WindField markov_wind(const Eigen::Vector3d& mean_W, double bound_mps, double along_rad,
                      double longest_s, std::uint64_t seed);

}  // namespace vinerow::test
