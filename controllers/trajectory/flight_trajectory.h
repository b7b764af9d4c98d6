#pragma once
/// Whole flight as a function of time: runs of the smoothed curve with their time laws, and rests
/// between them, in which the rotors spin up, the vehicle turns or holds its place.

#include <optional>
#include <vector>

#include "controllers/trajectory/time_law.h"
#include "controllers/trajectory/yaw_move.h"
#include "engine/api/messages/flight.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

/// Hold before the last run, the landing.
struct FlightHold {
  double duration_s = 0.0;  ///< infinite: never lands
  std::optional<double> yaw_rad;
};

struct FlightOptions {
  TrajectoryLimits limits;
  double spin_up_s = 1.0;                 ///< rest on the ground before the take-off
  double landing_reserve_m = 1.0;         ///< continuation of the landing below the plan's end
  double sharp_rad = rad_from_deg(20.0);  ///< the vehicle stops at sharper bends
  std::optional<FlightHold> hold;
};

class FlightTrajectory {
 public:
  using Phase = ReferenceTrajectory::Phase;
  struct Sample {
    TrajectoryPoint point;
    Phase phase = Phase::kWait;
    double distance_m = 0.0;  ///< along the plan
  };

  FlightTrajectory() = default;
  /// Allocates. @param yaw_rad  of the vehicle before the take-off
  FlightTrajectory(const PlannedPath& plan, double yaw_rad, const FlightOptions& options);

  /// True if the plan has no length.
  bool empty() const { return stages_.empty(); }
  double duration_s() const { return stages_.back().end_s; }
  /// Of the plan, without the continuation of the landing.
  double length_m() const { return length_m_; }
  double end_height_m() const { return end_height_m_; }

  /// Clamped to [0, duration_s()], but for a landing, which sinks on at its speed until the ground
  /// is met. No heap. @pre !empty()
  Sample at(double time_s) const;
  /// Time at which a distance along the plan is reached, s; zero if it is not positive, and the end
  /// if it exceeds the plan. No heap. @pre !empty()
  double time_of(double distance_m) const;

 private:
  struct Stage {
    double start_s = 0.0, end_s = 0.0;
    int run = -1;          ///< -1: rest
    bool follows = false;  ///< the yaw follows the path
    YawMove yaw;
    double yaw_shift_rad = 0.0;  ///< whole turns between the run's own yaw and the flight's
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
    Phase phase = Phase::kTransit;  ///< of rests and of vertical runs
    double start_m = 0.0;           ///< along the plan
  };
  /// At a time, or at the end.
  Sample find(double time_s) const;
  void add_rest(double duration_s, Phase phase);
  void add_run(int run, bool is_first, bool is_last, std::optional<double> next_yaw_rad,
               const FlightOptions& options);
  Phase phase_of(const Stage& stage, double along_m) const;

  std::vector<SmoothRun> runs_;
  std::vector<TimeLaw> laws_;
  std::vector<Stage> stages_;
  YawMove yaw_;  // the last turn on the spot, during construction
  Eigen::Vector3d p_W_ = Eigen::Vector3d::Zero();
  double now_s_ = 0.0, now_m_ = 0.0;
  bool has_flown_rows_ = false;
  double length_m_ = 0.0;
  double end_height_m_ = 0.0;
  double landing_mps_ = 0.0;
};

}  // namespace vinerow::controllers
