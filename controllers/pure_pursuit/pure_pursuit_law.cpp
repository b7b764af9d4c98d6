#include "controllers/pure_pursuit/pure_pursuit_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/parts/paths/path_corners.h"
#include "engine/api/messages/path.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kSpotGain_per_s = 2.0;  // turning on the spot: yaw rate per heading error
constexpr double kSpotMax_radps = 0.8;
constexpr double kTurned_rad = 0.087;  // 5 deg: the law takes over
constexpr double kCornerSpeed_mps = 0.1;

}  // namespace

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
  stretch_ends_.clear();
  for (const PathCorner& corner : find_corners(path, kSharpCorner_rad)) {
    stretch_ends_.push_back(corner.point);
  }
  stretch_ends_.push_back(static_cast<int>(points_.size()) - 1);
  stretch_ = 0;
  is_turning_ = false;
  index_ = 0;
  finished_ = false;
}

void PurePursuitLaw::advance_index(const Eigen::Vector2d& p) {
  const int last = stretch_last();
  while (index_ < last && (points_[index_ + 1] - p).norm() < params_.crossed_distance_m) ++index_;
}

Eigen::Vector2d PurePursuitLaw::find_local_goal(const Eigen::Vector2d& p) const {
  const int last = stretch_last();
  // Near the end the circle may have no intersection ahead.
  const bool is_near_its_end =
      distance_m_[last] - distance_m_[index_] <= params_.lookahead_m + longest_segment_m_;
  const bool aims = params_.aim_at_goal || !is_last_stretch();
  if (aims && is_near_its_end && (points_[last] - p).norm() < params_.lookahead_m) {
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
  if (distance_m_[stretch_last()] - distance_m_[index_] > reach + longest_segment_m_) return false;
  const double tolerance = std::max(params_.speed_mps * params_.cycle_s, params_.goal_tolerance_m);
  return (points_[stretch_last()] - p).norm() < tolerance;
}

double PurePursuitLaw::calc_corner_speed(const Eigen::Vector2d& p) const {
  if (is_last_stretch()) return std::numeric_limits<double>::infinity();
  const double left_m = (points_[stretch_last()] - p).norm();
  return std::sqrt(kCornerSpeed_mps * kCornerSpeed_mps + 2.0 * params_.brake_mps2 * left_m);
}

std::optional<VelocityCommand> PurePursuitLaw::turn_on_the_spot(double yaw_rad) {
  int next = index_ + 1;
  while (next < stretch_last() && points_[next] == points_[index_]) ++next;
  const Eigen::Vector2d along = points_[next] - points_[index_];
  const double theta = wrap_angle(std::atan2(along.y(), along.x()) - yaw_rad);
  is_turning_ = std::abs(theta) > kTurned_rad;
  if (!is_turning_) return std::nullopt;
  const double max_radps = std::min(params_.yaw_rate_limit_radps, kSpotMax_radps);
  return VelocityCommand{0.0, std::clamp(kSpotGain_per_s * theta, -max_radps, max_radps)};
}

VelocityCommand PurePursuitLaw::step(const Pose2& pose) {
  if (points_.empty() || finished_) return {};
  advance_index(pose.p);
  if (is_at_goal(pose.p)) {
    finished_ = is_last_stretch();
    if (finished_) return {};
    index_ = stretch_last();
    ++stretch_;
    is_turning_ = true;
  }
  if (is_turning_) {
    if (const auto turn = turn_on_the_spot(pose.yaw_rad)) return *turn;
  }

  local_goal_ = find_local_goal(pose.p);
  const Eigen::Vector2d to_goal = local_goal_ - pose.p;
  double theta = wrap_angle(std::atan2(to_goal.y(), to_goal.x()) - pose.yaw_rad);
  if (std::abs(theta) < params_.steering_threshold_rad) theta = 0.0;

  double full_speed = params_.speed_mps;
  if (speed_mps_[index_] > 0.0) full_speed = std::min(full_speed, speed_mps_[index_]);
  VelocityCommand command;
  const double share = std::max(1.0 - std::abs(theta) / params_.largest_angle_rad, 0.0);
  command.v_mps = std::min(full_speed * share, calc_corner_speed(pose.p));
  command.yaw_rate_radps = std::clamp(params_.turn_gain * theta / params_.cycle_s,
                                      -params_.yaw_rate_limit_radps, params_.yaw_rate_limit_radps);
  return command;
}

}  // namespace vinerow::controllers
