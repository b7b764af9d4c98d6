#pragma once
/// The plain quadrotor of quadrotor_sim.h in a loop (loop.h) under a registered controller. The
/// reference comes from a function of time or from a registered guidance.

#include <functional>
#include <optional>

#include "engine/api/messages/flight.h"
#include "tests/controllers/support/loop.h"
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

struct QuadrotorSetup {
  QuadrotorNumbers numbers = make_q4t();
  std::optional<QuadrotorNumbers> assumed;  ///< description for the controller; default: the truth
  PartChoice controller{"quadrotor_pid", {}};
  double rate_Hz = 0.0;      ///< of the controller; 0: its own
  Duration tick{1'000'000};  ///< of the loop; 0: the controller's period
  Duration physics{1'000'000};
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
  Pose start;                   ///< used with rotors_on: in hover there
  bool starts_on_path = false;  ///< instead: in hover where the path begins, with its speed
  bool rotors_on = true;
  double floor_m = -1e9;
};

class QuadrotorLoop : public Loop {
 public:
  explicit QuadrotorLoop(const QuadrotorSetup& setup);

  const QuadrotorSim& sim() const { return sim_; }
  QuadrotorSim& sim() { return sim_; }
  const ReferenceTrajectory& reference() const { return read<ReferenceTrajectory>("reference"); }
  void set_phase(Phase phase);
  /// From the path of the setup at this moment to the vehicle: x along the path's yaw, y left.
  Eigen::Vector3d path_error() const;

 private:
  void write_reference();

  QuadrotorSetup setup_;
  QuadrotorSim sim_;
  ReferenceTrajectory trajectory_;
};

/// A mean wind and bounded random gusts along the first axes of W, two or three: first-order noise
/// of sigma gust / 2 cut at the gust, correlated over correlation_s. Made beforehand, so that every
/// controller meets the same.
WindField gusty_wind(const Eigen::Vector3d& mean_W, double gust_mps, double correlation_s,
                     double longest_s, std::uint64_t seed, int axes = 2);

}  // namespace vinerow::test
