#include "controllers/path_follower/speed_profile.h"

#include <algorithm>
#include <cmath>

namespace vinerow {

SpeedProfile::SpeedProfile(const Path& path, const SpeedLimits& limits)
    : acceleration_mps2_(limits.acceleration_mps2), stretches_(path.segment_count()) {
  double end_mps = limits.goal_speed_mps;
  for (int i = path.segment_count() - 1; i >= 0; --i) {
    double cap = limits.speed_mps;
    if (path.speed_at(i) > 0.0) cap = std::min(cap, path.speed_at(i));
    const double curvature = std::abs(path.curvature_of(i));
    if (curvature > 0.0) {
      cap = std::min({cap, std::sqrt(limits.lateral_acceleration_mps2 / curvature),
                      limits.yaw_rate_radps / curvature});
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

}  // namespace vinerow
