#include "tests/controllers/support/swept_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "engine/api/messages/grid.h"
#include "engine/api/messages/path.h"
#include "engine/math/angles.h"

namespace vinerow::test {

using Vec = Eigen::Vector2d;
using Polygon = std::vector<Vec>;

namespace {

double distance_to_segment(const Vec& p, const Vec& a, const Vec& b) {
  const Vec ab = b - a;
  return (p - a - std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0) * ab).norm();
}

bool contains(const Polygon& polygon, const Vec& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (cross(polygon[(i + 1) % polygon.size()] - polygon[i], p - polygon[i]) < 0.0) return false;
  }
  return true;
}

bool crosses(const Vec& a, const Vec& b, const Vec& c, const Vec& d) {
  return cross(b - a, c - a) * cross(b - a, d - a) < 0.0 &&
         cross(d - c, a - c) * cross(d - c, b - c) < 0.0;
}

double gap_between(const Polygon& one, const Polygon& other) {
  if (contains(one, other[0]) || contains(other, one[0])) return 0.0;
  double nearest_m = 1e9;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Vec &a = one[i], &b = one[(i + 1) % one.size()];
    for (std::size_t k = 0; k < other.size(); ++k) {
      const Vec &c = other[k], &d = other[(k + 1) % other.size()];
      if (crosses(a, b, c, d)) return 0.0;
      nearest_m = std::min({nearest_m, distance_to_segment(a, c, d), distance_to_segment(c, a, b)});
    }
  }
  return nearest_m;
}

}  // namespace

double distance_to_cells(const Polygon& outline_B, const controllers::Pose2& pose,
                         const OccupancyGrid& grid, double reach_m) {
  Polygon outline;
  Eigen::AlignedBox2d box;
  for (const Vec& p_B : outline_B) {
    outline.push_back(pose.p + Eigen::Rotation2Dd(pose.yaw_rad) * p_B);
    box.extend(outline.back());
  }
  const Vec low = (box.min() - grid.corner_W) / grid.cell_m;
  const Vec high = (box.max() - grid.corner_W) / grid.cell_m;
  if (low.minCoeff() < 0.0 || high.x() > grid.columns || high.y() > grid.rows) return 0.0;
  const double reach = reach_m / grid.cell_m;
  const int first_i = std::max(0, static_cast<int>(low.x() - reach));
  const int first_j = std::max(0, static_cast<int>(low.y() - reach));
  const int last_i = std::min(grid.columns - 1, static_cast<int>(high.x() + reach));
  const int last_j = std::min(grid.rows - 1, static_cast<int>(high.y() + reach));
  double nearest_m = reach_m;
  for (int j = first_j; j <= last_j; ++j) {
    for (int i = first_i; i <= last_i; ++i) {
      if (!grid.occupied(i, j)) continue;
      const Vec corner = grid.corner_W + grid.cell_m * Vec(i, j);
      const double c = grid.cell_m;
      // Squares farther from the box around the outline than the least so far need no look.
      const Eigen::AlignedBox2d square(corner, corner + Vec(c, c));
      if (box.squaredExteriorDistance(square) >= nearest_m * nearest_m) continue;
      nearest_m =
          std::min(nearest_m, gap_between(outline, {corner, corner + Vec(c, 0), corner + Vec(c, c),
                                                    corner + Vec(0, c)}));
      if (nearest_m <= 0.0) return 0.0;
    }
  }
  return nearest_m;
}

SweptVerdict check_swept(const PlannedPath& path, const Polygon& outline_B,
                         const OccupancyGrid& grid, double step_m) {
  SweptVerdict verdict;
  constexpr double kMeets_m = 1e-6, kMeets_rad = 1e-6;
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
    const PathPoint &a = path.points[i], &b = path.points[i + 1];
    const double k = a.curvature_per_m, chord_m = (b.p_W - a.p_W).head<2>().norm();
    const double length_m =
        k == 0.0 ? chord_m : 2.0 / std::abs(k) * std::asin(0.5 * chord_m * std::abs(k));
    const controllers::Pose2 start = {a.p_W.head<2>(), a.yaw_rad};
    const int parts = std::max(1, static_cast<int>(std::ceil(length_m / step_m)));
    for (int s = 0; s <= parts; ++s) {
      const double at_m = length_m * s / parts;
      const controllers::Pose2 pose = controllers::advance(start, at_m, at_m * k);
      verdict.min_m = std::min(verdict.min_m, distance_to_cells(outline_B, pose, grid));
    }
    const controllers::Pose2 end = controllers::advance(start, length_m, length_m * k);
    if (verdict.fault.empty() && ((end.p - b.p_W.head<2>()).norm() > kMeets_m ||
                                  std::abs(wrap_angle(end.yaw_rad - b.yaw_rad)) > kMeets_rad)) {
      verdict.fault =
          fmt::format("point {} of {} does not follow from the one before: {} m, {} rad", i + 1,
                      path.points.size(), (end.p - b.p_W.head<2>()).norm(),
                      wrap_angle(end.yaw_rad - b.yaw_rad));
    }
    verdict.sharpest_per_m = std::max(verdict.sharpest_per_m, std::abs(k));
    verdict.length_m += length_m;
  }
  return verdict;
}

}  // namespace vinerow::test
