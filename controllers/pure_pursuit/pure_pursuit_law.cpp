#include "controllers/pure_pursuit/pure_pursuit_law.h"

#include <algorithm>
#include <cmath>

#include "engine/api/messages/path.h"
#include "engine/math/angles.h"

namespace vinerow {

std::optional<double> intersect_circle(const Eigen::Vector2d& centre, double radius_m,
                                       const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  // |from + s (to - from) - centre|^2 = radius^2, a quadratic in s.
  const Eigen::Vector2d along = to - from, offset = from - centre;
  const double a = along.squaredNorm();
  const double half_b = along.dot(offset);
  const double c = offset.squaredNorm() - radius_m * radius_m;
  const double discriminant = half_b * half_b - a * c;
  if (a <= 0.0 || discriminant < 0.0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  for (const double s : {(-half_b + root) / a, (-half_b - root) / a}) {
    if (s >= 0.0 && s <= 1.0) return s;
  }
  return std::nullopt;
}

void PurePursuitLaw::set_path(const PlannedPath& path) {
  points_.clear();
  distance_m_.clear();
  speed_mps_.clear();
  longest_segment_m_ = 0.0;
  for (const PathPoint& point : path.points) {
    const Eigen::Vector2d p = point.p_W.head<2>();
    const double gap = points_.empty() ? 0.0 : (p - points_.back()).norm();
    longest_segment_m_ = std::max(longest_segment_m_, gap);
    distance_m_.push_back(points_.empty() ? 0.0 : distance_m_.back() + gap);
    speed_mps_.push_back(point.speed_mps);
    points_.push_back(p);
  }
  index_ = 0;
  finished_ = false;
}

void PurePursuitLaw::advance_index(const Eigen::Vector2d& p) {
  const int last = static_cast<int>(points_.size()) - 1;
  while (index_ < last && (points_[index_ + 1] - p).norm() < params_.crossed_distance_m) ++index_;
}

Eigen::Vector2d PurePursuitLaw::find_local_goal(const Eigen::Vector2d& p) const {
  const int last = static_cast<int>(points_.size()) - 1;
  // Near the end the circle has nothing ahead to meet.
  const bool is_last_stretch =
      length_m() - distance_m_[index_] <= params_.lookahead_m + longest_segment_m_;
  if (params_.aim_at_goal && is_last_stretch && (points_[last] - p).norm() < params_.lookahead_m) {
    return points_[last];
  }
  for (int i = index_; i < last; ++i) {
    const auto share = intersect_circle(p, params_.lookahead_m, points_[i], points_[i + 1]);
    if (share) return points_[i] + *share * (points_[i + 1] - points_[i]);
  }
  return points_[index_];
}

bool PurePursuitLaw::is_at_goal(const Eigen::Vector2d& p) const {
  // The goal counts only from the last stretch on, so that a path may pass by or start at its goal.
  const double reach = std::max(params_.lookahead_m, params_.crossed_distance_m);
  if (length_m() - distance_m_[index_] > reach + longest_segment_m_) return false;
  const double tolerance = std::max(params_.speed_mps * params_.cycle_s, params_.goal_tolerance_m);
  return (points_.back() - p).norm() < tolerance;
}

VelocityCommand PurePursuitLaw::step(const Pose2& pose) {
  if (points_.empty() || finished_) return {};
  advance_index(pose.p);
  finished_ = is_at_goal(pose.p);
  if (finished_) return {};

  local_goal_ = find_local_goal(pose.p);
  const Eigen::Vector2d to_goal = local_goal_ - pose.p;
  double theta = wrap_angle(std::atan2(to_goal.y(), to_goal.x()) - pose.yaw_rad);
  if (std::abs(theta) < params_.steering_threshold_rad) theta = 0.0;

  double full_speed = params_.speed_mps;
  if (speed_mps_[index_] > 0.0) full_speed = std::min(full_speed, speed_mps_[index_]);
  VelocityCommand command;
  command.v_mps = full_speed * (1.0 - std::abs(theta) / params_.largest_angle_rad);
  command.yaw_rate_radps = std::clamp(params_.turn_gain * theta / params_.cycle_s,
                                      -params_.yaw_rate_limit_radps, params_.yaw_rate_limit_radps);
  return command;
}

}  // namespace vinerow
