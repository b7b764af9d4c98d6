#pragma once
/// Line of a row on the ground by arc length, and the frame of its plants.

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "engine/math/polyline.h"
#include "engine/math/pose.h"

namespace vinerow::mapping {

/// Height of the ground at (x, y) in W, m.
using GroundHeight = std::function<double(double x, double y)>;

/// Polyline in the horizontal plane, by horizontal arc length s from its first point.
class RowCurve {
 public:
  /// @param points_W  >= 2, neighbours distinct (demanded)
  explicit RowCurve(std::vector<Eigen::Vector2d> points_W);

  double length_m() const { return line_.length_m(); }
  const std::vector<Eigen::Vector2d>& points_W() const { return line_.points(); }
  /// Arc length of each point.
  const std::vector<double>& s_m() const { return line_.s_m(); }
  /// Unit direction of each segment.
  const std::vector<Eigen::Vector2d>& directions_W() const { return directions_; }
  /// Position at s; the line is extended straight beyond its ends.
  Eigen::Vector2d point_W(double s_m) const { return line_.point_at(s_m); }
  /// Unit direction at s.
  Eigen::Vector2d direction_W(double s_m) const { return line_.direction_at(s_m); }
  /// Arc length of the nearest point, within [0, length]. @param distance_m  set to the distance if
  /// not null
  double nearest_s_m(const Eigen::Vector2d& p_W, double* distance_m = nullptr) const;

 private:
  Polyline line_;
  std::vector<Eigen::Vector2d> directions_;
};

/// Horizontal projection of a line, without repeated points.
std::vector<Eigen::Vector2d> seen_from_above(const std::vector<Eigen::Vector3d>& line_W);

/// Frame R of a row at s: origin on the ground, x along the row and the ground's slope, y level to
/// the left, z away from the ground. Vines and posts lean with the slope along their row and are
/// upright across it.
Pose row_frame(const RowCurve& row, const GroundHeight& ground, double s_m);

/// Frame R of a stretch: origin on the ground at its start, x towards the ground at its end.
Pose stretch_frame(const RowCurve& row, const GroundHeight& ground, double start_m, double end_m);

}  // namespace vinerow::mapping
