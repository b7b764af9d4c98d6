#include "engine/physics/triangle_box.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vinerow::physics {
namespace {

using Eigen::Vector3d;

/// Signed distance of x beyond [-h, h].
double excess(double x, double h) {
  return x > h ? x - h : (x < -h ? x + h : 0.0);
}

Vector3d excess(const Vector3d& x, const Vector3d& h) {
  return {excess(x.x(), h.x()), excess(x.y(), h.y()), excess(x.z(), h.z())};
}

/// True if p, a point of the triangle's plane, is inside the triangle. n = (b-a) x (c-a).
bool is_inside(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c,
               const Vector3d& n) {
  return (b - a).cross(p - a).dot(n) >= 0.0 && (c - b).cross(p - b).dot(n) >= 0.0 &&
         (a - c).cross(p - c).dot(n) >= 0.0;
}

}  // namespace

double segment_box_distance2(const Vector3d& a, const Vector3d& b, const Vector3d& h) {
  const Vector3d d = b - a;
  const auto half_slope = [&](double t) { return d.dot(excess(a + t * d, h)); };
  if (half_slope(0.0) >= 0.0) return excess(a, h).squaredNorm();
  if (half_slope(1.0) <= 0.0) return excess(b, h).squaredNorm();

  // The slope changes sign between two neighbouring breakpoints (or ends): narrow [low, high]
  // breakpoint by breakpoint; between them the slope is linear.
  double low = 0.0, high = 1.0;
  double slope_low = half_slope(0.0), slope_high = half_slope(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) continue;
    for (const double side : {-h[axis], h[axis]}) {
      const double t = (side - a[axis]) / d[axis];
      if (!(t > low && t < high)) continue;
      const double slope = half_slope(t);
      if (slope < 0.0) {
        low = t;
        slope_low = slope;
      } else {
        high = t;
        slope_high = slope;
      }
    }
  }
  const double t = low + (high - low) * (slope_low / (slope_low - slope_high));
  return excess(a + t * d, h).squaredNorm();
}

double triangle_box_bound2(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                           const Vector3d& h) {
  const Vector3d low = a.cwiseMin(b).cwiseMin(c) - h;
  const Vector3d high = -(a.cwiseMax(b).cwiseMax(c)) - h;
  return low.cwiseMax(high).cwiseMax(0.0).squaredNorm();
}

double triangle_box_distance2(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                              const Vector3d& h) {
  double best = segment_box_distance2(a, b, h);
  if (best > 0.0) best = std::min(best, segment_box_distance2(b, c, h));
  if (best > 0.0) best = std::min(best, segment_box_distance2(c, a, h));
  if (best == 0.0) return 0.0;

  const Vector3d n = (b - a).cross(c - a);
  const double n2 = n.squaredNorm();
  if (!(n2 > 0.0)) return best;
  // Corner of the box farthest along n.
  const Vector3d corner(std::copysign(h.x(), n.x()), std::copysign(h.y(), n.y()),
                        std::copysign(h.z(), n.z()));
  const double reach = n.dot(corner);  // >= 0: the box spans n.x in [-reach, reach]
  const double offset = n.dot(a);      // the plane is n.x = offset
  if (std::abs(offset) <= reach) {
    const Vector3d on_plane = reach > 0.0 ? Vector3d(corner * (offset / reach)) : Vector3d::Zero();
    return is_inside(on_plane, a, b, c, n) ? 0.0 : best;
  }
  const Vector3d nearest = offset > 0.0 ? corner : Vector3d(-corner);
  const double height = offset - n.dot(nearest);  // times |n|
  const Vector3d foot = nearest + n * (height / n2);
  return is_inside(foot, a, b, c, n) ? std::min(best, height * height / n2) : best;
}

}  // namespace vinerow::physics
