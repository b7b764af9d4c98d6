#include "worlds/mapping/model/row_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"

namespace vinerow::mapping {
namespace {

Pose frame_through(const Eigen::Vector3d& origin, const Eigen::Vector3d& along) {
  const Eigen::Vector3d x = along.normalized();
  const Eigen::Vector3d y = Eigen::Vector3d(-x.y(), x.x(), 0.0).normalized();
  Eigen::Matrix3d R;
  R.col(0) = x;
  R.col(1) = y;
  R.col(2) = x.cross(y);
  return {Eigen::Quaterniond(R).normalized(), origin};
}

}  // namespace

RowCurve::RowCurve(std::vector<Eigen::Vector2d> points_W) : line_(std::move(points_W)) {
  const std::vector<Eigen::Vector2d>& points = line_.points();
  VINEROW_DEMAND(points.size() >= 2);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    VINEROW_DEMAND(s_m()[i + 1] > s_m()[i]);
    directions_.push_back((points[i + 1] - points[i]).normalized());
  }
}

double RowCurve::nearest_s_m(const Eigen::Vector2d& p_W, double* distance_m) const {
  double best_s_m = 0.0, best_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const Eigen::Vector2d &from = points_W()[i], &d = directions_[i];
    const double along = std::clamp((p_W - from).dot(d), 0.0, s_m()[i + 1] - s_m()[i]);
    const double apart_m = (from + along * d - p_W).norm();
    if (apart_m < best_m) {
      best_m = apart_m;
      best_s_m = s_m()[i] + along;
    }
  }
  if (distance_m != nullptr) *distance_m = best_m;
  return best_s_m;
}

std::vector<Eigen::Vector2d> seen_from_above(const std::vector<Eigen::Vector3d>& line_W) {
  constexpr double kSame_m = 1e-6;
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3d& p : line_W) {
    if (points.empty() || (p.head<2>() - points.back()).norm() > kSame_m) {
      points.push_back(p.head<2>());
    }
  }
  return points;
}

Pose stretch_frame(const RowCurve& row, const GroundHeight& ground, double start_m, double end_m) {
  const Eigen::Vector2d a = row.point_W(start_m), b = row.point_W(end_m);
  const Eigen::Vector3d start(a.x(), a.y(), ground(a.x(), a.y()));
  const Eigen::Vector3d end(b.x(), b.y(), ground(b.x(), b.y()));
  return frame_through(start, end - start);
}

Pose row_frame(const RowCurve& row, const GroundHeight& ground, double s_m) {
  // Slope from the ground around, so that a clod does not tilt a vine.
  constexpr double kReach_m = 1.0;
  const Eigen::Vector2d p = row.point_W(s_m);
  const Pose stretch = stretch_frame(row, ground, s_m - kReach_m, s_m + kReach_m);
  return {stretch.q, Eigen::Vector3d(p.x(), p.y(), ground(p.x(), p.y()))};
}

}  // namespace vinerow::mapping
