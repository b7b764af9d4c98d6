#pragma once
/// Path-following law of paper B: lookahead circle, local goal point, speeds (section 2.4).
///
/// Source: Martelli, Mocera, Soma, AgriEngineering 6(3), 2024, eq. 5-7 and figures 8-13. One cycle:
///   1. A waypoint is crossed when it is nearer than D_th; the current index is the last one
///      crossed.
///   2. The local goal point (LGP) is the first intersection of the lookahead circle with a segment
///      from the current index on; of two on one segment, the one nearer the segment's end. Without
///      an intersection it is the waypoint of the current index.
///   3. theta = phi - gamma (eq. 5), wrapped to (-pi, pi]: without that the mission fails as soon
///   as
///      headings pass 180 deg.
///   4. |theta| below the threshold counts as zero.
///   5. v = v_t (1 - |theta| / theta_max) (eq. 7, with |theta|: a turn to the right must not raise
///      the speed, and an angle beyond theta_max must not reverse it).
///   6. yaw rate = theta / t (eq. 6), limited to v_t / R_min (table 1).
/// Open in the paper and chosen here: D_th equals the lookahead distance, and the law aims at the
/// last waypoint once it is within the lookahead distance. Other choices loop about a waypoint or
/// never reach the goal (docs/papers/paper_b.md).
///
/// The paper's paths have no sharp corners, and its law circles about them. Here a sharp corner
/// (path_corners.h) is the goal of the stretch before it: the vehicle brakes, turns on the spot and
/// continues with the next stretch.

#include <optional>
#include <vector>

#include "controllers/parts/paths/pose2.h"
#include "engine/api/forward.h"
#include "engine/api/messages/commands.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

struct PurePursuitParams {
  double lookahead_m = 0.75;         ///< LD
  double crossed_distance_m = 0.75;  ///< D_th
  double speed_mps = 7.0 / 3.6;      ///< v_t
  double steering_threshold_rad = 0.0;
  double largest_angle_rad = rad_from_deg(360.0);  ///< theta_max
  double yaw_rate_limit_radps = 7.0 / 3.6;         ///< infinity = none
  double turn_gain = 1.0;                          ///< 1 = eq. 6
  double cycle_s = 0.025;                          ///< t
  double goal_tolerance_m = 0.1;
  double brake_mps2 = 0.8;  ///< before sharp corners
  bool aim_at_goal = true;
};

class PurePursuitLaw {
 public:
  explicit PurePursuitLaw(const PurePursuitParams& params) : params_(params) {}

  /// Takes over a path and starts at its first waypoint. Allocates.
  void set_path(const PlannedPath& path);

  /// One cycle. No heap.
  /// @returns the command; zero once the goal is reached or while there is no path
  VelocityCommand step(const Pose2& pose);

  bool has_path() const { return !points_.empty(); }
  bool finished() const { return finished_; }
  /// Index of the last waypoint crossed.
  int index() const { return index_; }
  /// Length of the polyline up to a waypoint.
  double distance_m(int waypoint) const { return distance_m_[waypoint]; }
  double length_m() const { return distance_m_.empty() ? 0.0 : distance_m_.back(); }
  const std::vector<Eigen::Vector2d>& points() const { return points_; }
  const Eigen::Vector2d& local_goal() const { return local_goal_; }

  /// First and last waypoint of the vehicle's stretch between two sharp corners.
  int stretch_first() const { return stretch_ == 0 ? 0 : stretch_ends_[stretch_ - 1]; }
  int stretch_last() const { return stretch_ends_[stretch_]; }
  bool is_last_stretch() const { return stretch_ + 1 == stretch_ends_.size(); }

 private:
  void advance_index(const Eigen::Vector2d& p);
  double calc_corner_speed(const Eigen::Vector2d& p) const;
  /// Turn towards the next stretch. @returns nullopt once the vehicle faces it
  std::optional<VelocityCommand> turn_on_the_spot(double yaw_rad);
  Eigen::Vector2d find_local_goal(const Eigen::Vector2d& p) const;
  bool is_at_goal(const Eigen::Vector2d& p) const;

  PurePursuitParams params_;
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> distance_m_;
  std::vector<double> speed_mps_;
  double longest_segment_m_ = 0.0;
  int index_ = 0;
  std::vector<int> stretch_ends_;  ///< waypoints: the sharp corners, and the last one
  std::size_t stretch_ = 0;
  bool is_turning_ = false;  ///< on the spot
  bool finished_ = false;
  Eigen::Vector2d local_goal_ = Eigen::Vector2d::Zero();
};

/// Intersection of a circle with a segment: the share of the segment in [0, 1], the larger of two.
/// @returns nullopt if the circle misses the segment (paper B, figure 10, cases a and b)
std::optional<double> intersect_circle(const Eigen::Vector2d& centre, double radius_m,
                                       const Eigen::Vector2d& from, const Eigen::Vector2d& to);

}  // namespace vinerow::controllers
