#include "engine/sim/metrics/plan_stretch.h"

#include <cmath>

namespace vinerow {

void PlanStretch::connect(Ports& ports) {
  plan_ = ports.read_optional<PlannedPath>("plan");
}

bool PlanStretch::take_over() {
  if (!plan_.has_value() || !plan_.is_newer_than(plan_seen_)) return false;
  if (plan_.value().points.size() < 2) return false;
  points_ = plan_.value().points;
  length_m_ = plan_.value().length_m;
  std::vector<Eigen::Vector2d> line;
  line.reserve(points_.size());
  for (const PathPoint& point : points_) line.push_back(point.p_W.head<2>());
  line_ = PolylineDistance(std::move(line));
  segment_ = 0;
  return true;
}

PolylineDistance::Nearest PlanStretch::find(const Eigen::Vector2d& p) {
  const PolylineDistance::Nearest nearest = line_.nearest(p, segment_);
  segment_ = nearest.segment;
  return nearest;
}

double PlanStretch::curve_distance_m(const PolylineDistance::Nearest& at,
                                     const Eigen::Vector2d& p) const {
  const double curvature = points_[at.segment].curvature_per_m;
  const Eigen::Vector2d& from = line_.points()[at.segment];
  const Eigen::Vector2d chord = line_.points()[at.segment + 1] - from;
  const double half_m = 0.5 * chord.norm();
  const bool inside = at.fraction > 0.0 && at.fraction < 1.0;
  if (!inside || std::abs(curvature) < 1e-9 || half_m * std::abs(curvature) >= 1.0) {
    return at.distance_m;
  }
  // The centre lies on the chord's bisector, to the left of a left bend.
  const double radius_m = 1.0 / std::abs(curvature);
  const double away_m = std::sqrt(radius_m * radius_m - half_m * half_m);
  const Eigen::Vector2d left = Eigen::Vector2d(-chord.y(), chord.x()) / (2.0 * half_m);
  const Eigen::Vector2d centre = from + 0.5 * chord + std::copysign(away_m, curvature) * left;
  return std::abs((p - centre).norm() - radius_m);
}

}  // namespace vinerow
