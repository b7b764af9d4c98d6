#include "controllers/dwa/plan_ahead.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/messages/path.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

// The vehicle is located within this distance along the plan around its last place, and at first
// from the plan's start.
constexpr double kSearchBack_m = 1.5;
constexpr double kSearchAhead_m = 2.0;
constexpr double kSearchFirst_m = 5.0;
// Rounding of distances between cell centres.
constexpr double kRounding_m = 1e-3;

}  // namespace

void PlanAhead::set_plan(const PlannedPath& plan) {
  path_ = Path(plan);
  at_ = {};
  is_located_ = false;
  window_.clear();
}

void PlanAhead::locate(const Pose2& pose) {
  const double from = is_located_ ? at_.distance_m - kSearchBack_m : 0.0;
  const double to = is_located_ ? at_.distance_m + kSearchAhead_m : kSearchFirst_m;
  at_ = path_.nearest(pose.p, std::max(from, 0.0), std::min(to, path_.length_m()), at_.segment);
  is_located_ = true;
  heading_error_rad_ = wrap_angle(pose.yaw_rad - at_.yaw_rad);
  window_.clear();
  // Samples are at whole pitches of the plan, so that they do not move with the vehicle.
  const int first =
      static_cast<int>(std::ceil(std::max(at_.distance_m - kBehind_m, 0.0) / kPitch_m));
  const double last_m = std::min(at_.distance_m + kAhead_m, path_.length_m());
  for (int i = first; i * kPitch_m < last_m; ++i) {
    window_.add(path_.pose_at(i * kPitch_m, at_.segment), i * kPitch_m);
  }
  window_.add(path_.pose_at(last_m, at_.segment), last_m);
  here_ = window_.index_at(at_.distance_m);
}

Pose2 PlanAhead::follow_pose(double ahead_m) const {
  const double left = std::exp(-ahead_m / params_.fade_m);
  Pose2 pose = path_.pose_at(at_.distance_m + ahead_m, at_.segment);
  pose.p += left * at_.lateral_error_m * left_of(direction(pose.yaw_rad));
  pose.yaw_rad += left * heading_error_rad_;
  return pose;
}

double PlanAhead::calc_free_m(const FreeSpaceFinder& free_space, const DiscOutline& outline,
                              const Pose2& pose, double length_m) const {
  const FreeSpace now = free_space.measure(outline, pose);
  const double end_m = std::min(length_m, remaining_m());
  double free_m = 0.0;
  for (int i = here_; i < window_.size(); ++i) {
    const double ahead_m = window_[i].distance_m - at_.distance_m;
    if (ahead_m > end_m) break;
    const Pose2 follow = follow_pose(ahead_m);
    const Eigen::Vector2d ahead = direction(follow.yaw_rad);
    const FreeSpace cheap{params_.follow_margin_m, params_.obstacle_margin_m};
    if (!free_space.meets(outline, follow.p, ahead, cheap)) {
      const FreeSpace there = free_space.measure(outline, follow.p, ahead);
      const FreeSpace plan = free_space.measure(outline, window_[i].p, window_[i].ahead);
      const FreeSpace need{
          std::min({params_.follow_margin_m, plan.known_m, now.known_m}) - kRounding_m,
          std::min(params_.obstacle_margin_m, now.unknown_m - kRounding_m)};
      const double touches_m = std::min(params_.follow_margin_m, 0.0);
      const bool hits_map = there.known_m <= touches_m && now.known_m > touches_m;
      if (hits_map || !there.meets(need)) return free_m;
    }
    free_m = ahead_m;
  }
  return end_m;
}

bool PlanAhead::is_lane_free(const FreeSpaceFinder& free_space, const DiscOutline& outline,
                             double left_m) const {
  const double reach_m = std::abs(left_m - at_.lateral_error_m) / params_.crab_slope;
  for (int i = window_.index_at(at_.distance_m + reach_m); i < window_.size(); ++i) {
    const LocalPath::Sample& sample = window_[i];
    if (sample.distance_m > at_.distance_m + params_.lane_length_m) break;
    const Eigen::Vector2d p = sample.p + left_m * left_of(sample.ahead);
    if (free_space.meets(outline, p, sample.ahead, {params_.margin_m, params_.obstacle_margin_m})) {
      continue;
    }
    // If the plan itself is nearer to the map than the margin, that distance is allowed.
    const double known_m = free_space.measure(outline, sample.p, sample.ahead).known_m;
    const FreeSpace need{std::min(params_.margin_m, known_m - kRounding_m),
                         params_.obstacle_margin_m};
    if (!free_space.measure(outline, p, sample.ahead).meets(need)) return false;
  }
  return true;
}

bool PlanAhead::find_lane(const FreeSpaceFinder& free_space, const DiscOutline& outline,
                          double before_m, double* left_m) const {
  // A change of the displacement costs half as much as the displacement itself.
  const auto cost = [&](double left) { return std::abs(left) + 0.5 * std::abs(left - before_m); };
  const int count = static_cast<int>(params_.lane_max_m / params_.lane_step_m + 1e-9);
  double best = std::numeric_limits<double>::infinity();
  *left_m = 0.0;
  for (int i = -count; i <= count; ++i) {
    const double left = i * params_.lane_step_m;
    if (cost(left) >= best || !is_lane_free(free_space, outline, left)) continue;
    best = cost(left);
    *left_m = left;
  }
  return std::isfinite(best);
}

}  // namespace vinerow::controllers
