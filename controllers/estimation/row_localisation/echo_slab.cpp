#include "controllers/estimation/row_localisation/echo_slab.h"

#include <cmath>

namespace vinerow::controllers {

EchoSlab echo_slab(const RangePrediction& facet, const Eigen::Vector3d& p_WB, double range_m,
                   const EchoBounds& bounds) {
  const Eigen::Vector3d& N = facet.hit.normal_W;
  const Eigen::Vector3d v_W = facet.origin_W - p_WB + range_m * facet.dir_W;
  const double turn_m = std::abs(N.y() * v_W.x() - N.x() * v_W.y());  // N'(z x v)
  const double bend_m = std::abs(N.head<2>().dot(v_W.head<2>()));
  const double half_m = (std::abs(facet.slope()) + bounds.yaw_rad) * bounds.reading_m +
                        bounds.map_m + bounds.yaw_rad * turn_m +
                        0.5 * bounds.yaw_rad * bounds.yaw_rad * bend_m;
  const double middle_m = facet.hit.plane_m - N.dot(v_W);
  return {N, middle_m - half_m, middle_m + half_m};
}

EchoSlab2 horizontal_slab(const EchoSlab& slab, double height_m, double height_bound_m) {
  const double rise_m = slab.normal_W.z() * height_m;
  const double bound_m = std::abs(slab.normal_W.z()) * height_bound_m;
  return {slab.normal_W.head<2>(), slab.lower_m - rise_m - bound_m,
          slab.upper_m - rise_m + bound_m};
}

}  // namespace vinerow::controllers
