#include "controllers/estimation/row_localisation/row_line.h"

#include <algorithm>

namespace vinerow::controllers {

LinePoint nearest_on_piece(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                           const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d edge_W = to_W - from_W;
  const Eigen::Vector2d flat = edge_W.head<2>();
  if (flat.isZero()) return {};
  const double t = (p_W - from_W).head<2>().dot(flat) / flat.squaredNorm();
  const Eigen::Vector3d at_W = from_W + std::clamp(t, 0.0, 1.0) * edge_W;
  return {at_W, edge_W, (p_W - at_W).head<2>().norm()};
}

LinePoint nearest_on(std::span<const Eigen::Vector3d> line_W, const Eigen::Vector3d& p_W) {
  LinePoint nearest;
  for (std::size_t i = 0; i + 1 < line_W.size(); ++i) {
    const LinePoint point = nearest_on_piece(line_W[i], line_W[i + 1], p_W);
    if (point.distance_m < nearest.distance_m) nearest = point;
  }
  return nearest;
}

}  // namespace vinerow::controllers
