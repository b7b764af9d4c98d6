#include "controllers/parts/paths/arc3.h"

#include <algorithm>

#include "engine/math/angles.h"

namespace vinerow::controllers {

Result<Arc3> make_arc3(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                       const Eigen::Vector2d& c) {
  const Eigen::Vector2d ab = b - a, bc = c - b, ac = c - a;
  const double product = ab.norm() * bc.norm() * ac.norm();
  const double longest = std::max({ab.norm(), bc.norm(), ac.norm()});
  // Menger curvature: four times the triangle's area over the product of its sides.
  const double curvature = product > 0.0 ? 2.0 * cross(ab, ac) / product : 0.0;
  if (product <= 0.0) return Failure{"two of the three points of an arc coincide"};
  if (std::abs(curvature) * longest < 1e-6) {
    return Failure{"the three points of an arc are on a line"};
  }
  // Inscribed angles: a chord seen from a third point of the circle spans half the angle of its
  // arc. Each of the two arcs is below a full turn, so their sum is right beyond 180 deg too.
  const auto sweep_seen_from = [](const Eigen::Vector2d& to_start, const Eigen::Vector2d& to_end) {
    return 2.0 * std::atan2(std::abs(cross(to_start, to_end)), to_start.dot(to_end));
  };
  const double sweep_ab = sweep_seen_from(a - c, b - c);
  const double sweep_bc = sweep_seen_from(b - a, c - a);
  const double sign = curvature > 0.0 ? 1.0 : -1.0;
  Arc3 arc;
  arc.curvature_per_m = curvature;
  arc.length_m = (sweep_ab + sweep_bc) / std::abs(curvature);
  arc.start.p = a;
  arc.start.yaw_rad = wrap_angle(std::atan2(ab.y(), ab.x()) - sign * 0.5 * sweep_ab);
  return arc;
}

}  // namespace vinerow::controllers
