#include "controllers/path_follower/speed_profile.h"

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/path_corners.h"

namespace vinerow::controllers {
namespace {

constexpr double kSmooth_rad = 0.17;  // 10 deg: smaller jumps are no corners

double calc_bend_speed(const SpeedLimits& limits, double curvature_per_m) {
  return std::min(std::sqrt(limits.lateral_acceleration_mps2 / curvature_per_m),
                  limits.yaw_rate_radps / curvature_per_m);
}

double calc_corner_speed(const SpeedLimits& limits, double jump_rad) {
  if (std::abs(jump_rad) > kSharpCorner_rad) return limits.goal_speed_mps;
  return calc_bend_speed(limits, std::abs(jump_rad) / limits.corner_m);
}

}  // namespace

SpeedProfile::SpeedProfile(const Path& path, const SpeedLimits& limits)
    : acceleration_mps2_(limits.acceleration_mps2), stretches_(path.segment_count()) {
  double end_mps = limits.goal_speed_mps;
  for (int i = path.segment_count() - 1; i >= 0; --i) {
    double cap = limits.speed_mps;
    if (path.speed_at(i) > 0.0) cap = std::min(cap, path.speed_at(i));
    const double curvature = std::abs(path.curvature_of(i));
    if (curvature > 0.0) cap = std::min(cap, calc_bend_speed(limits, curvature));
    if (i + 1 < path.segment_count() && std::abs(path.jump_at(i + 1)) > kSmooth_rad) {
      end_mps = std::min(end_mps, calc_corner_speed(limits, path.jump_at(i + 1)));
    }
    stretches_[i] = {cap, std::min(cap, end_mps)};
    const double length = path.end_of(i) - path.start_of(i);
    end_mps = std::min(cap, std::sqrt(stretches_[i].end_mps * stretches_[i].end_mps +
                                      2.0 * acceleration_mps2_ * length));
  }
}

double SpeedProfile::speed_at(const Path& path, int segment, double distance_m) const {
  const Stretch& stretch = stretches_[segment];
  const double left_m = std::max(path.end_of(segment) - distance_m, 0.0);
  return std::min(stretch.cap_mps,
                  std::sqrt(stretch.end_mps * stretch.end_mps + 2.0 * acceleration_mps2_ * left_m));
}

}  // namespace vinerow::controllers
