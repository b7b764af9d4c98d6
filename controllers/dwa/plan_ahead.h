#pragma once
/// Where the vehicle is on its plan, what comes next, and how far that is free.

#include "controllers/dwa/local_path.h"
#include "controllers/dwa/vehicle_room.h"
#include "controllers/parts/paths/path_curve.h"
#include "engine/api/forward.h"

namespace vinerow::controllers {

struct PlanAheadParams {
  double fade_m = 1.2;              ///< a tracking error dies out over this length
  double margin_m = 0.05;           ///< to what the map knows
  double follow_margin_m = 0.02;    ///< to what the map knows, while following
  double obstacle_margin_m = 0.15;  ///< to what was seen
  double lane_most_m = 0.7;         ///< farthest way beside the plan
  double lane_step_m = 0.05;
  double lane_length_m = 3.0;  ///< over which such a way must be free
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
  /// Finds the vehicle on the plan, near where it was. @pre !empty()
  void locate(const Pose2& pose);

  double distance_m() const { return at_.distance_m; }
  double remaining_m() const { return path_.length_m() - at_.distance_m; }
  double lateral_error_m() const { return at_.lateral_error_m; }
  /// Wanted speed here, 0 = nothing wanted.
  double speed_mps() const { return path_.speed_at(at_.segment); }
  const LocalPath& window() const { return window_; }
  int here() const { return here_; }  ///< sample of the window at the vehicle

  /// Where a tracking controller will be after `ahead_m` along the plan: the plan's pose, with what
  /// is left of the present error.
  Pose2 follow_pose(double ahead_m) const;
  /// How far the way of follow_pose() is free, at most `length_m`. Against the map only the
  /// vehicle's own deviation can be at fault: where the plan itself comes nearer than the margin,
  /// the planner has answered for it.
  double calc_free_m(const RoomFinder& rooms, const DiscOutline& outline, const Pose2& pose,
                     double length_m) const;

  /// Sideways displacement of the plan (positive left) that is free over lane_length_m from where
  /// it can be reached; the smallest, near `before_m`.
  /// @param left_m  out; 0 where none is free  @returns whether one is free
  bool find_lane(const RoomFinder& rooms, const DiscOutline& outline, double before_m,
                 double* left_m) const;

 private:
  bool is_lane_free(const RoomFinder& rooms, const DiscOutline& outline, double left_m) const;

  PlanAheadParams params_;
  Path path_;
  Path::Nearest at_;
  double heading_error_rad_ = 0.0;
  bool is_located_ = false;
  LocalPath window_;
  int here_ = 0;
};

}  // namespace vinerow::controllers
