#pragma once
/// Planned path as a curve: an arc of the stated curvature between each two points.
///
/// The planner's points carry the exact curvature of each stretch, so distance, heading and
/// lateral error are those of the planned straights and arcs, not of the chords between waypoints.
/// Built when a plan arrives (allocates); queries use no heap.

#include <vector>

#include "controllers/parts/paths/pose2.h"
#include "engine/api/forward.h"

namespace vinerow::controllers {

class Path {
 public:
  struct Nearest {
    double distance_m = 0.0;       ///< along the path
    double lateral_error_m = 0.0;  ///< of the query point, positive: left of the path
    double yaw_rad = 0.0;          ///< direction of travel at the nearest point
    double curvature_per_m = 0.0;
    int segment = 0;
  };

  Path() = default;
  /// @param plan  points closer than a micrometre to their predecessor are skipped
  explicit Path(const PlannedPath& plan);

  bool empty() const { return segments_.empty(); }
  double length_m() const { return length_m_; }
  int segment_count() const { return static_cast<int>(segments_.size()); }
  const Pose2& goal() const { return goal_; }

  /// Segment that contains a distance, clamped to the path. @param hint  a segment nearby
  int segment_at(double distance_m, int hint = 0) const;
  Pose2 pose_at(double distance_m, int hint = 0) const;
  double curvature_at(double distance_m, int hint = 0) const;
  /// Heading change from distance a to b (a <= b), the integral of curvature without the jumps at
  /// corners. Beyond the end the path goes straight on.
  double turn_between_rad(double a_m, double b_m, int hint = 0) const;
  /// Wanted speed of the stretch, 0 = the follower's own.
  double speed_at(int segment) const { return segments_[segment].speed_mps; }
  double start_of(int segment) const { return segments_[segment].start_m; }
  double end_of(int segment) const {
    return segments_[segment].start_m + segments_[segment].length_m;
  }
  double curvature_of(int segment) const { return segments_[segment].curvature_per_m; }
  /// Jump of the direction at the start of a segment, positive to the left, in (-pi, pi].
  double jump_at(int segment) const;

  /// Nearest point between two distances along the path. The window keeps a follower from jumping
  /// to another pass of the path. Beyond either end of the path the error is measured from its
  /// tangent.
  Nearest nearest(const Eigen::Vector2d& p, double from_m, double to_m, int hint = 0) const;

 private:
  struct Segment {
    Pose2 start;
    double start_m = 0.0;
    double length_m = 0.0;
    double curvature_per_m = 0.0;
    double speed_mps = 0.0;
  };
  std::vector<Segment> segments_;
  Pose2 goal_;
  double length_m_ = 0.0;
};

}  // namespace vinerow::controllers
