#include "controllers/parts/paths/path_curve.h"

#include <algorithm>
#include <limits>

#include "engine/api/messages/path.h"
#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {
constexpr double kShortestChord_m = 1e-6;
// A longer chord, as a share of the diameter, does not fit the stated arc.
constexpr double kLargestChordShare = 0.999;
}  // namespace

Path::Path(const PlannedPath& plan) {
  segments_.reserve(plan.points.size());
  const PathPoint* from = nullptr;
  for (const PathPoint& to : plan.points) {
    if (from == nullptr) {
      from = &to;
      goal_ = {to.p_W.head<2>(), to.yaw_rad};
      continue;
    }
    const Eigen::Vector2d chord = to.p_W.head<2>() - from->p_W.head<2>();
    const double chord_m = chord.norm();
    if (chord_m < kShortestChord_m) continue;
    Segment segment;
    segment.start_m = length_m_;
    segment.speed_mps = from->speed_mps;
    segment.curvature_per_m = from->curvature_per_m;
    double half = 0.5 * segment.curvature_per_m * chord_m;
    if (std::abs(half) > kLargestChordShare) half = segment.curvature_per_m = 0.0;
    half = std::asin(half);
    segment.length_m = std::abs(half) < 1e-8 ? chord_m : 2.0 * half / segment.curvature_per_m;
    segment.start = {from->p_W.head<2>(), std::atan2(chord.y(), chord.x()) - half};
    segments_.push_back(segment);
    length_m_ += segment.length_m;
    goal_ = {to.p_W.head<2>(), segment.start.yaw_rad + 2.0 * half};
    from = &to;
  }
}

int Path::segment_at(double distance_m, int hint) const {
  VINEROW_ASSERT(!empty());
  int i = std::clamp(hint, 0, segment_count() - 1);
  while (i > 0 && distance_m < segments_[i].start_m) --i;
  while (i + 1 < segment_count() && distance_m >= segments_[i + 1].start_m) ++i;
  return i;
}

Pose2 Path::pose_at(double distance_m, int hint) const {
  const Segment& segment = segments_[segment_at(distance_m, hint)];
  const double along = std::clamp(distance_m - segment.start_m, 0.0, segment.length_m);
  return advance(segment.start, along, along * segment.curvature_per_m);
}

double Path::curvature_at(double distance_m, int hint) const {
  return distance_m > length_m_ ? 0.0 : segments_[segment_at(distance_m, hint)].curvature_per_m;
}

double Path::turn_between_rad(double a_m, double b_m, int hint) const {
  double turn = 0.0;
  for (int i = segment_at(a_m, hint); i < segment_count() && segments_[i].start_m < b_m; ++i) {
    const double from = std::max(a_m, segments_[i].start_m);
    const double to = std::min(b_m, segments_[i].start_m + segments_[i].length_m);
    turn += std::max(to - from, 0.0) * segments_[i].curvature_per_m;
  }
  return turn;
}

double Path::jump_at(int segment) const {
  if (segment == 0) return 0.0;
  const Segment& before = segments_[segment - 1];
  const double arrival_rad = before.start.yaw_rad + before.length_m * before.curvature_per_m;
  return wrap_angle(segments_[segment].start.yaw_rad - arrival_rad);
}

Path::Nearest Path::nearest(const Eigen::Vector2d& p, double from_m, double to_m, int hint) const {
  VINEROW_ASSERT(!empty());
  Nearest best;
  double best_gap = std::numeric_limits<double>::infinity();
  for (int i = segment_at(from_m, hint); i < segment_count(); ++i) {
    const Segment& segment = segments_[i];
    if (segment.start_m > to_m) break;
    // Distance along the segment (straight: projection; arc: angle about the centre).
    const Eigen::Vector2d tangent = direction(segment.start.yaw_rad);
    const Eigen::Vector2d offset = p - segment.start.p;
    const double k = segment.curvature_per_m;
    double along = offset.dot(tangent);
    if (k != 0.0) along = std::atan2(k * along, 1.0 - k * offset.dot(left_of(tangent))) / k;
    const double low = std::max(0.0, from_m - segment.start_m);
    const double high = std::min(segment.length_m, to_m - segment.start_m);
    along = std::clamp(along, low, std::max(low, high));
    const Pose2 pose = advance(segment.start, along, along * k);
    const double gap = (p - pose.p).squaredNorm();
    if (gap >= best_gap) continue;
    best_gap = gap;
    best.distance_m = segment.start_m + along;
    best.lateral_error_m = cross(direction(pose.yaw_rad), p - pose.p);
    best.yaw_rad = pose.yaw_rad;
    best.curvature_per_m = k;
    best.segment = i;
  }
  return best;
}

}  // namespace vinerow::controllers
