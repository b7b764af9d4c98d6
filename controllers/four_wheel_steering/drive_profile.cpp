#include "controllers/four_wheel_steering/drive_profile.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {
namespace {

constexpr double kStraight_per_m = 0.05;  // curves wider than 20 m are driven like straights
constexpr double kLargestMiss_m = 0.006;  // lateral error from averaging a step of curvature

/// A step averaged over the length v * swing misses the path by step (v swing)^2 / 24.
double calc_step_speed(double step_per_m, double swing_s) {
  return std::sqrt(24.0 * kLargestMiss_m / std::max(std::abs(step_per_m), 1e-9)) / swing_s;
}

}  // namespace

DriveProfile::DriveProfile(const Path& path, const DriveLimits& limits)
    : limits_(limits), stretches_(path.segment_count()) {
  double end_mps = limits.goal_speed_mps;
  for (int i = path.segment_count() - 1; i >= 0; --i) {
    const double curvature = path.curvature_of(i);
    double cap = limits.speed_mps;
    if (std::abs(curvature) > kStraight_per_m) cap = std::min(cap, limits.turn_speed_mps);
    if (path.speed_at(i) > 0.0) cap = std::min(cap, path.speed_at(i));
    if (i + 1 < path.segment_count()) {
      const double step = path.curvature_of(i + 1) - curvature;
      end_mps = std::min(end_mps, calc_step_speed(step, limits.swing_s));
    }
    stretches_[i] = {cap, std::min(cap, end_mps)};
    const double length = path.end_of(i) - path.start_of(i);
    end_mps = std::min(cap, std::sqrt(stretches_[i].end_mps * stretches_[i].end_mps +
                                      2.0 * limits.acceleration_mps2 * length));
  }
}

double DriveProfile::stretch_speed(const Path& path, int segment, double distance_m) const {
  const Stretch& stretch = stretches_[segment];
  const double left_m = std::max(path.end_of(segment) - distance_m, 0.0);
  return std::min(stretch.cap_mps, std::sqrt(stretch.end_mps * stretch.end_mps +
                                             2.0 * limits_.acceleration_mps2 * left_m));
}

double DriveProfile::speed_at(const Path& path, int segment, double distance_m) const {
  const double here = stretch_speed(path, segment, distance_m);
  const double ahead_m = distance_m + 0.5 * here * limits_.swing_s;
  if (ahead_m >= path.length_m()) return here;
  return std::min(here, stretch_speed(path, path.segment_at(ahead_m, segment), ahead_m));
}

}  // namespace vinerow::controllers
