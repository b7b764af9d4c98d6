#include "controllers/estimation/row_ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/angles.h"

namespace vinerow {
namespace {

struct RowPoint {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d along_W = Eigen::Vector3d::UnitX();
  double distance_m = std::numeric_limits<double>::infinity();  // seen from above
};

RowPoint nearest_on(const PlantRow& row, const Eigen::Vector3d& p_W) {
  RowPoint nearest;
  for (std::size_t i = 0; i + 1 < row.line_W.size(); ++i) {
    const Eigen::Vector3d edge_W = row.line_W[i + 1] - row.line_W[i];
    const Eigen::Vector2d flat = edge_W.head<2>();
    if (flat.isZero()) continue;
    const double t = (p_W - row.line_W[i]).head<2>().dot(flat) / flat.squaredNorm();
    const Eigen::Vector3d at_W = row.line_W[i] + std::clamp(t, 0.0, 1.0) * edge_W;
    const double distance_m = (p_W - at_W).head<2>().norm();
    if (distance_m < nearest.distance_m) nearest = {at_W, edge_W, distance_m};
  }
  return nearest;
}

}  // namespace

std::optional<GroundPlane> find_ground(const RowMap& map, const Eigen::Vector3d& p_W) {
  RowPoint first, second;
  for (const PlantRow& row : map.rows) {
    const RowPoint point = nearest_on(row, p_W);
    if (point.distance_m < first.distance_m) {
      second = first;
      first = point;
    } else if (point.distance_m < second.distance_m) {
      second = point;
    }
  }
  if (!std::isfinite(second.distance_m)) return std::nullopt;
  Eigen::Vector3d normal_W = first.along_W.cross(second.p_W - first.p_W);
  if (std::abs(normal_W.z()) < 1e-6) return std::nullopt;
  normal_W *= std::copysign(1.0, normal_W.z()) / normal_W.norm();
  return GroundPlane{normal_W, normal_W.dot(first.p_W)};
}

std::optional<double> plane_distance_m(const GroundPlane& ground, const Eigen::Vector3d& dir_W,
                                       double half_angle_rad, double range_m) {
  const double off_rad = std::acos(std::clamp(-ground.normal_W.dot(dir_W), -1.0, 1.0));
  // The nearest point of the plane is at a right angle if the cone reaches so far.
  const double ray_rad = std::max(0.0, off_rad - half_angle_rad);
  if (ray_rad > 0.45 * kPi) return std::nullopt;
  return range_m * std::cos(ray_rad);
}

}  // namespace vinerow
