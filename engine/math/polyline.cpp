#include "engine/math/polyline.h"

#include <cmath>

namespace vinerow {
namespace {
constexpr int kBlock = 32;      // segments per bounding box
constexpr int kHintWindow = 4;  // segments tried first on either side of the hint
}  // namespace

template <int kDimension>
PolylineIn<kDimension>::PolylineIn(std::vector<Point> points) : points_(std::move(points)) {
  if (points_.empty()) return;
  if (points_.size() == 1) points_.push_back(points_.front());
  blocks_.resize((points_.size() - 2) / kBlock + 1);
  s_m_.push_back(0.0);
  for (int i = 0; i < segments(); ++i) {
    blocks_[i / kBlock].extend(points_[i]);
    blocks_[i / kBlock].extend(points_[i + 1]);
    s_m_.push_back(s_m_.back() + (points_[i + 1] - points_[i]).norm());
  }
}

template <int kDimension>
void PolylineIn<kDimension>::try_segment(int segment, const Point& p, Nearest& best) const {
  const Point &a = points_[segment], &b = points_[segment + 1];
  const Point ab = b - a, ap = p - a;
  const double fraction = segment_share<kDimension>(p, a, b);
  const Point point = a + fraction * ab;
  const double distance = (p - point).norm();
  if (distance >= best.distance_m) return;
  const double cross = ab.x() * ap.y() - ab.y() * ap.x();
  best = {distance, std::copysign(distance, cross), segment, fraction, point};
}

template <int kDimension>
typename PolylineIn<kDimension>::Nearest PolylineIn<kDimension>::nearest_within(const Point& p,
                                                                                int first,
                                                                                int last) const {
  Nearest best;
  if (points_.empty()) return best;
  first = std::clamp(first, 0, segments() - 1);
  last = std::clamp(last, first, segments() - 1);
  for (int i = first; i <= last; ++i) try_segment(i, p, best);
  return best;
}

template <int kDimension>
typename PolylineIn<kDimension>::Nearest PolylineIn<kDimension>::nearest(const Point& p,
                                                                         int hint_segment) const {
  // First guess near the hint, then only the blocks whose box is nearer than the best so far.
  Nearest best = nearest_within(p, hint_segment - kHintWindow, hint_segment + kHintWindow);
  for (int block = 0; block < static_cast<int>(blocks_.size()); ++block) {
    const double reach = best.distance_m;
    if (blocks_[block].squaredExteriorDistance(p) >= reach * reach) continue;
    const int end = std::min((block + 1) * kBlock, segments());
    for (int i = block * kBlock; i < end; ++i) try_segment(i, p, best);
  }
  return best;
}

template <int kDimension>
double PolylineIn<kDimension>::s_m(const Nearest& at) const {
  const double from_m = s_m_[at.segment];
  return from_m + at.fraction * (s_m_[at.segment + 1] - from_m);
}

template <int kDimension>
std::size_t PolylineIn<kDimension>::segment_at(double s_m) const {
  const auto after = std::upper_bound(s_m_.begin() + 1, s_m_.end() - 1, s_m);
  return static_cast<std::size_t>(after - s_m_.begin()) - 1;
}

template <int kDimension>
typename PolylineIn<kDimension>::Point PolylineIn<kDimension>::direction_at(double s_m) const {
  const std::size_t i = segment_at(s_m);
  return (points_[i + 1] - points_[i]).normalized();
}

template <int kDimension>
typename PolylineIn<kDimension>::Point PolylineIn<kDimension>::point_at(double s_m) const {
  const std::size_t i = segment_at(s_m);
  return points_[i] + (s_m - s_m_[i]) * (points_[i + 1] - points_[i]).normalized();
}

template class PolylineIn<2>;
template class PolylineIn<3>;

std::vector<Eigen::Vector2d> from_above(std::span<const Eigen::Vector3d> line) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(line.size());
  for (const Eigen::Vector3d& p : line) points.push_back(p.head<2>());
  return points;
}

LinePoint nearest_from_above(std::span<const Eigen::Vector3d> line, const Eigen::Vector2d& p) {
  LinePoint nearest;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector3d edge = line[i + 1] - line[i];
    if (edge.head<2>().isZero()) continue;
    const double share = segment_share<2>(p, line[i].head<2>(), line[i + 1].head<2>());
    const Eigen::Vector3d at = line[i] + share * edge;
    const double distance_m = (p - at.head<2>()).norm();
    if (distance_m < nearest.distance_m) nearest = {at, edge, distance_m};
  }
  return nearest;
}

}  // namespace vinerow
