#include "controllers/estimation/row_ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "controllers/estimation/row_line.h"
#include "engine/math/angles.h"

namespace vinerow {

std::optional<GroundPlane> RowGround::at(const Eigen::Vector3d& p_W) const {
  const auto [first, second] = lines_.nearest_rows(p_W);
  if (!std::isfinite(second.distance_m)) return std::nullopt;
  Eigen::Vector3d normal_W = first.edge_W.cross(second.p_W - first.p_W);
  if (std::abs(normal_W.z()) < 1e-6) return std::nullopt;
  normal_W *= std::copysign(1.0, normal_W.z()) / normal_W.norm();
  const std::array across = {first.p_W, second.p_W};
  return GroundPlane{normal_W, normal_W.dot(first.p_W), nearest_on(across, p_W).distance_m};
}

namespace {

/// Between the plane's downward normal and the ray of the cone that is nearest to it.
double nearest_ray_rad(const GroundPlane& ground, const Eigen::Vector3d& dir_W,
                       double half_angle_rad) {
  const double off_rad = std::acos(std::clamp(-ground.normal_W.dot(dir_W), -1.0, 1.0));
  return std::max(0.0, off_rad - half_angle_rad);
}

}  // namespace

std::optional<double> plane_distance_m(const GroundPlane& ground, const Eigen::Vector3d& dir_W,
                                       double half_angle_rad, double range_m) {
  // The nearest point of the plane is at a right angle if the cone reaches so far.
  const double ray_rad = nearest_ray_rad(ground, dir_W, half_angle_rad);
  if (ray_rad > 0.45 * kPi) return std::nullopt;
  return range_m * std::cos(ray_rad);
}

std::optional<double> nearest_in_cone_m(const GroundPlane& ground, const Eigen::Vector3d& sensor_W,
                                        const Eigen::Vector3d& dir_W, double half_angle_rad) {
  const double ray_rad = nearest_ray_rad(ground, dir_W, half_angle_rad);
  if (ray_rad > 0.499 * kPi) return std::nullopt;
  return std::max(0.0, ground.normal_W.dot(sensor_W) - ground.offset_m) / std::cos(ray_rad);
}

}  // namespace vinerow
