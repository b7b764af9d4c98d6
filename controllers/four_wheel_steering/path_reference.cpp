#include "controllers/four_wheel_steering/path_reference.h"

#include <algorithm>
#include <cmath>

#include "engine/api/messages/path.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kSearchBehind_m = 0.5;  // a noisy position may be behind the last one
constexpr double kSearchAhead_m = 1.0;
constexpr double kFirstSearch_m = 3.0;  // range for a vehicle that has just received its path
constexpr double kMinWindow_m = 0.05;
constexpr int kSamples = 4;  // per half window

/// Heading of the path averaged over the window minus its heading in the middle, rad.
double calc_heading_lead(const Path& path, double middle_m, double window_m, int hint) {
  const double part_m = 0.5 * window_m / kSamples;
  double lead = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double near_m = i * part_m, far_m = near_m + part_m;
    const double weight = 0.5 - (i + 0.5) * part_m / window_m;
    lead += weight * (path.turn_between_rad(middle_m + near_m, middle_m + far_m, hint) -
                      path.turn_between_rad(middle_m - far_m, middle_m - near_m, hint));
  }
  return lead;
}

}  // namespace

void PathTracker::set_path(const PlannedPath& plan) {
  path_ = Path(plan);
  distance_m_ = -1.0;
  segment_ = 0;
}

PathReference PathTracker::update(const Pose2& pose, double speed_mps) {
  const bool is_first = distance_m_ < 0.0;
  const double from_m = is_first ? 0.0 : distance_m_ - kSearchBehind_m;
  const double to_m = is_first ? kFirstSearch_m : distance_m_ + kSearchAhead_m;
  PathReference reference;
  reference.at = path_.nearest(pose.p, from_m, to_m, segment_);
  distance_m_ = reference.at.distance_m;
  segment_ = reference.at.segment;

  const double speed = std::max(speed_mps, 0.0);
  const double window_m = std::max(speed * params_.swing_s, kMinWindow_m);
  const double ahead_m = distance_m_ + speed * params_.response_s;
  reference.curvature_per_m =
      path_.turn_between_rad(ahead_m - 0.5 * window_m, ahead_m + 0.5 * window_m, segment_) /
      window_m;
  reference.heading_error_rad = wrap_angle(pose.yaw_rad - reference.at.yaw_rad);
  reference.smooth_heading_error_rad = wrap_angle(
      reference.heading_error_rad - calc_heading_lead(path_, distance_m_, window_m, segment_));
  return reference;
}

double calc_slope_factor(const Eigen::Quaterniond& q_WB, double yaw_rad) {
  constexpr double kSteepest = 0.7;  // normal's z of the steepest possible ground
  const Eigen::Vector3d n = q_WB * Eigen::Vector3d::UnitZ();
  const double n_z = std::max(n.z(), kSteepest);
  const double rise = -(n.x() * std::cos(yaw_rad) + n.y() * std::sin(yaw_rad)) / n_z;
  const double cosine = 1.0 / std::sqrt(1.0 + rise * rise);
  return cosine * cosine * cosine / n_z;
}

}  // namespace vinerow::controllers
