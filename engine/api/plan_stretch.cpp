#include "engine/api/plan_stretch.h"

#include <algorithm>
#include <cmath>

namespace vinerow {

void PlanStretch::connect(Ports& ports) {
  plan_ = ports.read_optional<PlannedPath>("plan");
}

bool PlanStretch::take_over() {
  if (!plan_.has_value() || !plan_.is_newer_than(plan_seen_)) return false;
  return take_over(plan_.value());
}

bool PlanStretch::take_over(const PlannedPath& plan) {
  if (plan.points.size() < 2) return false;
  points_ = plan.points;
  length_m_ = plan.length_m;
  std::vector<Eigen::Vector2d> line;
  line.reserve(points_.size());
  for (const PathPoint& point : points_) line.push_back(point.p_W.head<2>());
  line_ = Polyline(std::move(line));
  flight_.reset();
  const bool flies = std::any_of(points_.begin(), points_.end(), [](const PathPoint& point) {
    return point.kind == PathKind::kVertical || point.kind == PathKind::kReturn;
  });
  if (flies) {
    std::vector<Eigen::Vector3d> in_space;
    in_space.reserve(points_.size());
    for (const PathPoint& point : points_) in_space.push_back(point.p_W);
    flight_.emplace(std::move(in_space));
  }
  segment_ = 0;
  return true;
}

PlanStretch::Place PlanStretch::find(const Eigen::Vector3d& p_W) {
  const Eigen::Vector2d p = p_W.head<2>();
  Place place;
  Polyline::Nearest in_plane;
  if (flight_) {
    const SpacePolyline::Nearest in_space = flight_->nearest(p_W, segment_);
    in_plane = line_.nearest_within(p, in_space.segment, in_space.segment);
    place.distance_m = in_space.distance_m;
  } else {
    in_plane = line_.nearest(p, segment_);
    place.distance_m = in_plane.distance_m;
  }
  segment_ = place.segment = in_plane.segment;
  place.fraction = in_plane.fraction;
  place.lateral_m = in_plane.distance_m;
  const double from_m = points_[segment_].p_W.z(), to_m = points_[segment_ + 1].p_W.z();
  place.plan_z_m = from_m + place.fraction * (to_m - from_m);
  return place;
}

int PlanStretch::lane(const Eigen::Vector3d& p_W, const Eigen::Vector3d& v_W) {
  constexpr double kMinSpeed_mps = 0.1, kMinCosine = 0.5;
  if (!has_plan()) return -1;
  const Place place = find(p_W);
  if (!is_leg(place.segment)) return -1;
  const Eigen::Vector2d along =
      (points_[place.segment + 1].p_W - points_[place.segment].p_W).head<2>();
  const Eigen::Vector2d motion = v_W.head<2>();
  if (motion.norm() > kMinSpeed_mps &&
      motion.dot(along) < kMinCosine * motion.norm() * along.norm()) {
    return -1;
  }
  return std::max(0, points_[place.segment].alley);
}

bool PlanStretch::is_steep(int segment) const {
  const Eigen::Vector3d motion = points_[segment + 1].p_W - points_[segment].p_W;
  return std::abs(motion.z()) > motion.head<2>().norm();
}

double PlanStretch::curve_distance_m(const Place& at, const Eigen::Vector2d& p) const {
  const double curvature = points_[at.segment].curvature_per_m;
  const Eigen::Vector2d& from = line_.points()[at.segment];
  const Eigen::Vector2d chord = line_.points()[at.segment + 1] - from;
  const double half_m = 0.5 * chord.norm();
  const bool inside = at.fraction > 0.0 && at.fraction < 1.0;
  if (!inside || std::abs(curvature) < 1e-9 || half_m * std::abs(curvature) >= 1.0) {
    return at.lateral_m;
  }
  // The centre is on the chord's bisector, to the left in a left bend.
  const double radius_m = 1.0 / std::abs(curvature);
  const double away_m = std::sqrt(radius_m * radius_m - half_m * half_m);
  const Eigen::Vector2d left = Eigen::Vector2d(-chord.y(), chord.x()) / (2.0 * half_m);
  const Eigen::Vector2d centre = from + 0.5 * chord + std::copysign(away_m, curvature) * left;
  return std::abs((p - centre).norm() - radius_m);
}

}  // namespace vinerow
