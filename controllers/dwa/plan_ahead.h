#pragma once
/// Position of the vehicle on its plan, the plan ahead, and how far it is free.

#include "controllers/dwa/local_path.h"
#include "controllers/dwa/vehicle_clearance.h"
#include "controllers/parts/paths/path_curve.h"
#include "engine/api/forward.h"

namespace vinerow::controllers {

struct PlanAheadParams {
  double fade_m = 1.2;              ///< a tracking error decays over this length
  double margin_m = 0.05;           ///< to obstacles of the map
  double follow_margin_m = 0.02;    ///< to obstacles of the map, while following
  double obstacle_margin_m = 0.15;  ///< to detected obstacles
  double lane_max_m = 0.7;          ///< largest displacement of a path beside the plan
  double lane_step_m = 0.05;
  double lane_length_m = 3.0;  ///< over which such a path must be free
  double crab_slope = 0.4;     ///< sideways per metre forward
};

class PlanAhead {
 public:
  static constexpr double kPitch_m = 0.1;   ///< of the window's samples
  static constexpr double kBehind_m = 0.5;  ///< the window starts this far behind the vehicle
  static constexpr double kAhead_m = 4.5;

  explicit PlanAhead(const PlanAheadParams& params) : params_(params) {}

  /// Takes over a plan. Allocates.
  void set_plan(const PlannedPath& plan);
  bool empty() const { return path_.empty(); }
  /// Locates the vehicle on the plan, near its last place. @pre !empty()
  void locate(const Pose2& pose);

  double distance_m() const { return at_.distance_m; }
  double remaining_m() const { return path_.length_m() - at_.distance_m; }
  double lateral_error_m() const { return at_.lateral_error_m; }
  /// Wanted speed here, 0 = none.
  double speed_mps() const { return path_.speed_at(at_.segment); }
  const LocalPath& window() const { return window_; }
  int here() const { return here_; }  ///< sample of the window at the vehicle

  /// Predicted pose of a tracking controller after `ahead_m` along the plan: the plan's pose plus
  /// the remainder of the present error.
  Pose2 follow_pose(double ahead_m) const;
  /// Distance over which the poses of follow_pose() are free, at most `length_m`. For obstacles of
  /// the map only the vehicle's own deviation counts: where the plan itself comes nearer than the
  /// margin, the planner has accepted that.
  double calc_free_m(const FreeSpaceFinder& free_space, const DiscOutline& outline,
                     const Pose2& pose, double length_m) const;

  /// Sideways displacement of the plan (positive left) that is free over lane_length_m from where
  /// it can be reached; the smallest, near `before_m`.
  /// @param left_m  out; 0 if none is free  @returns whether one is free
  bool find_lane(const FreeSpaceFinder& free_space, const DiscOutline& outline, double before_m,
                 double* left_m) const;

 private:
  bool is_lane_free(const FreeSpaceFinder& free_space, const DiscOutline& outline,
                    double left_m) const;

  PlanAheadParams params_;
  Path path_;
  Path::Nearest at_;
  double heading_error_rad_ = 0.0;
  bool is_located_ = false;
  LocalPath window_;
  int here_ = 0;
};

}  // namespace vinerow::controllers
