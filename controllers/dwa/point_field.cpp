#include "controllers/dwa/point_field.h"

#include <algorithm>
#include <cmath>

#include "engine/core/constants.h"

namespace vinerow::controllers {
namespace {
constexpr float kFar = static_cast<float>(PointField::kReach_m);
constexpr int kReachNodes = static_cast<int>(PointField::kReach_m / PointField::kSpacing_m) + 1;
}  // namespace

PointField::PointField() : distance_m_(kNodes * kNodes, kFar) {}

void PointField::build(const Eigen::Vector2d& centre_W, std::span<const Eigen::Vector2d> points_W) {
  empty_ = points_W.empty();
  if (empty_) return;
  corner_W_ = centre_W - Eigen::Vector2d::Constant(0.5 * (kNodes - 1) * kSpacing_m);
  std::fill(distance_m_.begin(), distance_m_.end(), kFar * kFar);
  for (const Eigen::Vector2d& point : points_W) {
    const Eigen::Vector2d at = (point - corner_W_) / kSpacing_m;
    // Far outside the window nothing is in reach, and the cast below stays in range.
    if (!(at.cwiseAbs().maxCoeff() < 2.0 * kNodes)) continue;
    const int i0 = static_cast<int>(std::floor(at.x())), j0 = static_cast<int>(std::floor(at.y()));
    const int i_low = std::max(i0 - kReachNodes, 0),
              i_high = std::min(i0 + kReachNodes, kNodes - 1);
    const int j_low = std::max(j0 - kReachNodes, 0),
              j_high = std::min(j0 + kReachNodes, kNodes - 1);
    const float px = static_cast<float>(at.x()), py = static_cast<float>(at.y());
    constexpr float kSquare = static_cast<float>(kSpacing_m * kSpacing_m);
    for (int j = j_low; j <= j_high; ++j) {
      float* row = &distance_m_[static_cast<std::size_t>(j) * kNodes];
      const float dy = static_cast<float>(j) - py;
      for (int i = i_low; i <= i_high; ++i) {
        const float dx = static_cast<float>(i) - px;
        row[i] = std::min(row[i], (dx * dx + dy * dy) * kSquare);
      }
    }
  }
  for (float& d : distance_m_) d = std::sqrt(d);
}

double PointField::at(const Eigen::Vector2d& p_W) const {
  if (empty_) return kInfinity;
  const double x = (p_W.x() - corner_W_.x()) / kSpacing_m;
  const double y = (p_W.y() - corner_W_.y()) / kSpacing_m;
  if (!(x >= 0.0 && y >= 0.0 && x < kNodes - 1 && y < kNodes - 1)) return kInfinity;
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const float* d = &distance_m_[static_cast<std::size_t>(j) * kNodes + i];
  const double u = x - i, v = y - j;
  const double distance_m =
      (1 - v) * ((1 - u) * d[0] + u * d[1]) + v * ((1 - u) * d[kNodes] + u * d[kNodes + 1]);
  return distance_m >= kReach_m - 1e-5 ? kInfinity : distance_m;
}

}  // namespace vinerow::controllers
