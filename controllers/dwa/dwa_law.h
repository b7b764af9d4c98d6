#pragma once
/// Dynamic window approach for a vehicle with two steered axles.
///
/// Paper A, section 3.2, eq. (23), as corrected: of the four numbers (v_F, v_R, d_F, d_R) only
/// three are free, since rolling demands v_F cos d_F = v_R cos d_R. So (v, d_F, d_R) is sampled
/// within the range that the vehicle can reach in one window. Each sample is rolled out, its
/// clearance along the rollout is checked, and
///   J = alpha min(d_O, d_sat) - beta d_goal - zeta |heading error| - eta mean path distance
/// is maximised. The printed J = alpha d_O + beta d_goal drives away from the goal; it can be
/// chosen to show that. d_O is the clearance at the end of the rollout, d_goal the distance from
/// there to a point on the plan ahead (not the final goal). A sample is admissible if it is free
/// over the horizon and can stop in time (Fox, Burgard, Thrun, IEEE Robotics & Automation Magazine
/// 4(1), 1997: v <= sqrt(2 a_max distance)).
///
/// Default weights: chosen on the turn of the paper's figure 18, where they follow the plan and a
/// path weight of 1 or less jams (tests/controllers/dwa).

#include <array>

#include "controllers/dwa/four_wheel_motion.h"
#include "controllers/dwa/local_path.h"
#include "controllers/dwa/vehicle_clearance.h"

namespace vinerow::controllers {

struct DwaCost {
  double clearance_weight = 0.4;  ///< alpha, per m
  double goal_weight = 1.0;       ///< beta, per m
  double heading_weight = 0.3;    ///< zeta, per rad
  double path_weight = 3.0;       ///< eta, per m
  double saturation_m = 0.6;      ///< d_sat
  bool as_printed = false;        ///< J = alpha d_O + beta d_goal
};

/// Terms of J: the end of a rollout and its poses.
struct DwaTerms {
  double clearance_m = 0.0;
  double goal_m = 0.0;
  double heading_error_rad = 0.0;
  double path_m = 0.0;
};
double calc_score(const DwaTerms& terms, const DwaCost& cost);

struct DwaParams {
  SteeredVehicle geometry;
  double acceleration_mps2 = 0.5;
  double window_s = 0.2;   ///< the dynamic window: time within which commands must be reachable
  double horizon_s = 1.4;  ///< of the rollouts
  double step_s = 0.1;     ///< between checked poses of a rollout
  int speeds = 4;          ///< samples
  int steers = 9;          ///< samples per axle
  DwaCost cost;
};

/// A rollout: the poses after each step, without the start.
struct Rollout {
  static constexpr int kMax = 64;
  struct Node {
    Eigen::Vector2d p = Eigen::Vector2d::Zero();
    Eigen::Vector2d ahead = Eigen::Vector2d::UnitX();  ///< unit vector of yaw_rad
    double yaw_rad = 0.0;
  };
  int count = 0;
  std::array<Node, kMax> nodes;
};

/// Curvature and course of the vehicle in each step while the axles turn to `target` at their rate.
struct SteeringSweep {
  struct Step {
    double curvature_per_m = 0.0;
    Eigen::Vector2d course = Eigen::Vector2d::UnitX();  ///< unit vector in B
  };
  int count = 0;  ///< the last one holds from then on
  std::array<Step, Rollout::kMax> steps;
};
void calc_sweep(const AxleAngles& steering, const AxleAngles& target,
                const SteeredVehicle& geometry, double step_s, SteeringSweep* out);

/// Drives `v_mps` through a sweep.
void roll_out(const Pose2& start, double v_mps, const SteeringSweep& sweep, double horizon_s,
              double step_s, Rollout* out);
/// Drives `v_mps` (negative: backwards) while the axles turn to `target` at their rate.
void roll_out(const Pose2& start, double v_mps, const AxleAngles& steering,
              const AxleAngles& target, const SteeredVehicle& geometry, double horizon_s,
              double step_s, Rollout* out);

/// A command and its score.
struct DwaChoice {
  double v_mps = 0.0;
  AxleAngles steering;
  bool is_admissible = false;
  double score = 0.0;
  FreeSpace clearance;    ///< smallest along the rollout
  double travel_m = 0.0;  ///< along the rollout
};

/// Current motion of the vehicle.
struct DwaState {
  Pose2 pose;
  double v_mps = 0.0;  ///< of the centre, negative backwards
  AxleAngles steering;
};

/// Path, goal and limits for the evaluation of rollouts.
struct DwaTask {
  const LocalPath* path = nullptr;  ///< not empty
  int path_hint = 0;                ///< sample near the vehicle
  Eigen::Vector2d goal_W = Eigen::Vector2d::Zero();
  double v_low_mps = 0.0;   ///< commands are between these two
  double v_high_mps = 1.0;  ///< negative backwards
  FreeSpace need;           ///< clearance that every pose must have
};

class DwaLaw {
 public:
  DwaLaw(const DwaParams& params, DiscOutline outline, const FreeSpaceFinder& free_space)
      : params_(params), outline_(std::move(outline)), free_space_(free_space) {}

  /// The best of all samples. No heap; 324 rollouts at the default counts.
  /// @returns is_admissible false and zero speed if no sample moves freely
  DwaChoice choose(const DwaState& state, const DwaTask& task) const;
  /// Terms of J for a whole rollout.
  DwaTerms judge(const Rollout& rollout, const DwaTask& task) const;
  /// `wanted` if there is that much clearance now; else the present clearance, so that a motion
  /// which keeps or increases it is not refused.
  FreeSpace calc_need(const Pose2& pose, const FreeSpace& wanted) const;

  const DwaParams& params() const { return params_; }
  const DiscOutline& outline() const { return outline_; }

 private:
  DwaParams params_;
  DiscOutline outline_;
  FreeSpaceFinder free_space_;
};

}  // namespace vinerow::controllers
