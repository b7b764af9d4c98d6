#include "controllers/parts/paths/footprint.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr int kCoverCircles = 3;
constexpr double kEdgeSpacing_m = 0.25;  // without a grid

}  // namespace

Footprint::Footprint(const DistanceField& field, std::vector<Eigen::Vector2d> outline_B,
                     double margin_m)
    : field_(&field), outline_B_(std::move(outline_B)), margin_m_(margin_m) {
  VINEROW_DEMAND(outline_B_.size() >= 3 && margin_m >= 0.0);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : outline_B_) box.extend(p);
  const double slice_m = box.sizes().x() / kCoverCircles;
  for (int i = 0; i < kCoverCircles; ++i) {
    cover_.push_back({{box.min().x() + (i + 0.5) * slice_m, box.center().y()},
                      std::hypot(0.5 * slice_m, 0.5 * box.sizes().y())});
  }
  const double spacing_m = field.empty() ? kEdgeSpacing_m : field.cell_m();
  for (std::size_t i = 0; i < outline_B_.size(); ++i) {
    const Eigen::Vector2d &a = outline_B_[i], &b = outline_B_[(i + 1) % outline_B_.size()];
    const int parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing_m)));
    for (int k = 0; k < parts; ++k) edge_B_.push_back(a + (b - a) * k / parts);
  }
  edge_reach_m_ = 0.5 * spacing_m;
  for (const Eigen::Vector2d& p : outline_B_) farthest_m_ = std::max(farthest_m_, p.norm());
  // An object wholly inside the outline touches none of its edges, so the inside needs samples of
  // its own: discs inside the outline that cover all but a thin rim. They form rings that touch the
  // edges, the discs of each ring three times as large as those of the ring before, and one more
  // ring along the middle.
  double deepest_m = 0.0;
  for (double step_m = box.sizes().norm(); step_m > 1e-6; step_m *= 0.5) {
    if (!inset(outline_B_, deepest_m + step_m).empty()) deepest_m += step_m;
  }
  constexpr double kSmallestDisc_m = 0.1, kGrowth = 3.0, kMiddle = 0.98;
  for (double depth_m = kSmallestDisc_m; depth_m < kMiddle * deepest_m; depth_m *= kGrowth) {
    add_ring(depth_m);
  }
  add_ring(kMiddle * deepest_m);
}

void Footprint::add_ring(double depth_m) {
  const std::vector<Eigen::Vector2d> ring = inset(outline_B_, depth_m);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const int parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / depth_m)));
    for (int k = 0; k < parts; ++k) inside_B_.push_back({a + (b - a) * k / parts, depth_m});
  }
}

double Footprint::clearance_m(const Pose2& pose) const {
  const Eigen::Vector2d ahead = direction(pose.yaw_rad), left = left_of(ahead);
  const auto at = [&](const Eigen::Vector2d& p_B) {
    return field_->at(pose.p + p_B.x() * ahead + p_B.y() * left);
  };
  double min_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p_B : edge_B_) min_m = std::min(min_m, at(p_B));
  if (min_m < edge_reach_m_) return 0.0;
  for (const Circle& disc : inside_B_) {
    if (at(disc.centre_B) < disc.radius_m) return 0.0;
  }
  return min_m;
}

bool Footprint::is_free(const Pose2& pose) const {
  return is_clear(pose, std::max(margin_m_, edge_reach_m_), margin_m_);
}

bool Footprint::is_clear(const Pose2& pose, double min_clearance_m, double far_clearance_m) const {
  const Eigen::Vector2d ahead = direction(pose.yaw_rad), left = left_of(ahead);
  bool is_far = true;
  for (const Circle& circle : cover_) {
    const double distance_m =
        field_->at(pose.p + circle.centre_B.x() * ahead + circle.centre_B.y() * left);
    if (distance_m <= 0.0) return false;
    is_far = is_far && distance_m >= circle.radius_m + far_clearance_m;
  }
  if (is_far) return true;
  return clearance_m(pose) >= min_clearance_m;
}

/// A point of the outline moves by at most (1 + |curvature| r) per metre driven. So if the
/// clearance in the middle exceeds that factor times half the length, the whole arc is clear.
bool Footprint::is_swept_clear(const Pose2& start, double from_m, double to_m,
                               double curvature_per_m, double min_m) const {
  constexpr double kShortest_m = 1e-3;
  const double middle_m = 0.5 * (from_m + to_m), half_m = 0.5 * std::abs(to_m - from_m);
  const Pose2 pose = advance(start, middle_m, middle_m * curvature_per_m);
  const double reach_m = half_m * (1.0 + std::abs(curvature_per_m) * farthest_m_);
  if (is_clear(pose, min_m + reach_m, min_m + reach_m)) return true;
  if (!is_clear(pose, min_m, min_m)) return false;
  if (half_m < kShortest_m) return true;
  return is_swept_clear(start, from_m, middle_m, curvature_per_m, min_m) &&
         is_swept_clear(start, middle_m, to_m, curvature_per_m, min_m);
}

bool Footprint::is_free_along(const Pose2& start, double length_m, double curvature_per_m,
                              double step_m) const {
  const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(length_m) / step_m)));
  for (int i = 0; i <= parts; ++i) {
    const double s = length_m * i / parts;
    if (!is_free(advance(start, s, s * curvature_per_m))) return false;
  }
  constexpr double kNick_m = 0.01;
  const double min_m = std::max(margin_m_ - kNick_m, edge_reach_m_);
  for (int i = 0; i < parts; ++i) {
    if (!is_swept_clear(start, length_m * i / parts, length_m * (i + 1) / parts, curvature_per_m,
                        min_m)) {
      return false;
    }
  }
  return true;
}

double Footprint::clearance_along_m(const Pose2& start, double length_m, double curvature_per_m,
                                    double step_m) const {
  const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(length_m) / step_m)));
  double min_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= parts; ++i) {
    const double s = length_m * i / parts;
    min_m = std::min(min_m, clearance_m(advance(start, s, s * curvature_per_m)));
  }
  return min_m;
}

std::string to_string(const Pose2& pose) {
  return fmt::format("({:.2f}, {:.2f}) heading {:.1f} deg", pose.p.x(), pose.p.y(),
                     deg_from_rad(wrap_angle(pose.yaw_rad)));
}

std::string describe_clearance(const Pose2& pose, const Footprint& footprint) {
  if (!footprint.field().covers(pose.p)) {
    return to_string(pose) + " is outside the map's occupancy grid";
  }
  return fmt::format("at {} the footprint has {:.3f} m of clearance, the margin is {:.3f} m",
                     to_string(pose), footprint.clearance_m(pose), footprint.margin_m());
}

}  // namespace vinerow::controllers
