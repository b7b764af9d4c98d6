#pragma once
/// Segments and polylines in the plane and in space: nearest point, arc length, direction.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace vinerow {

template <int kDimension>
using PointIn = Eigen::Matrix<double, kDimension, 1>;

/// Nearest point of the segment from a to b, as its share 0..1 of the segment. 0 for a segment
/// without length.
template <int kDimension>
double segment_share(const PointIn<kDimension>& p, const PointIn<kDimension>& a,
                     const PointIn<kDimension>& b) {
  const PointIn<kDimension> ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0.0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
}

template <int kDimension>
PointIn<kDimension> nearest_on_segment(const PointIn<kDimension>& p, const PointIn<kDimension>& a,
                                       const PointIn<kDimension>& b) {
  return a + segment_share<kDimension>(p, a, b) * (b - a);
}

template <int kDimension>
double distance_to_segment_m(const PointIn<kDimension>& p, const PointIn<kDimension>& a,
                             const PointIn<kDimension>& b) {
  return (p - a - segment_share<kDimension>(p, a, b) * (b - a)).norm();
}

/// Polyline in the plane (kDimension 2) or in space (3) with exact distance queries. Neighbouring
/// points may be equal.
template <int kDimension>
class PolylineIn {
 public:
  using Point = PointIn<kDimension>;

  struct Nearest {
    double distance_m = std::numeric_limits<double>::infinity();
    double signed_distance_m = 0.0;  ///< positive: left of the nearest segment, seen from above
    int segment = 0;                 ///< index of its first point
    double fraction = 0.0;           ///< 0..1 along the segment
    Point point = Point::Zero();
  };

  /// Without points; every distance is infinite.
  PolylineIn() = default;
  /// @param points  m; a single point is a polyline of length zero
  explicit PolylineIn(std::vector<Point> points);

  /// Nearest point of the whole polyline. Among equals, the one on the lowest segment that was
  /// tried first from the hint. Cost: a few segments and one box per 32 segments; no heap.
  /// @param hint_segment  start of the search; affects the cost, never the distance
  Nearest nearest(const Point& p, int hint_segment = 0) const;

  /// Nearest point among segments [first, last] only, clamped to the polyline.
  Nearest nearest_within(const Point& p, int first, int last) const;

  const std::vector<Point>& points() const { return points_; }
  int segments() const { return points_.empty() ? 0 : static_cast<int>(points_.size()) - 1; }
  double length_m() const { return points_.empty() ? 0.0 : s_m_.back(); }

  /// Arc length of each point, from the first one.
  const std::vector<double>& s_m() const { return s_m_; }
  double s_m(const Nearest& at) const;
  /// Whether the nearest point is the first or the last point of the polyline.
  bool is_end(const Nearest& at) const {
    return (at.segment == 0 && at.fraction <= 0.0) ||
           (at.segment + 1 == segments() && at.fraction >= 1.0);
  }

  /// Position at an arc length; the first and the last segment are extended straight.
  /// @pre length_m() > 0
  Point point_at(double s_m) const;
  /// Unit direction at an arc length. @pre length_m() > 0
  Point direction_at(double s_m) const;

 private:
  void try_segment(int segment, const Point& p, Nearest& best) const;
  std::size_t segment_at(double s_m) const;

  std::vector<Point> points_;
  std::vector<double> s_m_;
  std::vector<Eigen::AlignedBox<double, kDimension>> blocks_;  ///< of 32 segments each
};

extern template class PolylineIn<2>;
extern template class PolylineIn<3>;

using Polyline = PolylineIn<2>;
using SpacePolyline = PolylineIn<3>;

/// The points of a line in space as seen from above.
std::vector<Eigen::Vector2d> from_above(std::span<const Eigen::Vector3d> line);

/// A point on a line in space.
struct LinePoint {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d edge = Eigen::Vector3d::UnitX();  ///< the segment that contains it, m, not unit
  double distance_m = std::numeric_limits<double>::infinity();  ///< seen from above
};

/// Point of a line in space that is nearest to p seen from above; the first among equals.
/// @returns a distance of +infinity if no segment of the line has any length seen from above
LinePoint nearest_from_above(std::span<const Eigen::Vector3d> line, const Eigen::Vector2d& p);

}  // namespace vinerow
