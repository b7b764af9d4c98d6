#include "controllers/estimation/row_localisation/row_ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kReach_m = 1.0;  // reach of the differences for the terrain's slope, to each side

}  // namespace

RowGround::RowGround(const RowMap& map) : terrain_(map.terrain) {
  std::vector<Polyline> lines;
  for (const PlantRow& row : map.rows) {
    lines_W_.push_back(row.line_W);
    lines.emplace_back(from_above(row.line_W));
  }
  index_ = PolylineIndex(std::move(lines));
}

GroundPlane RowGround::on_terrain(const Eigen::Vector2d& p_W) const {
  const HeightField& terrain = *terrain_;
  const Eigen::Vector2d low = terrain.corner_W,
                        high = low + Eigen::Vector2d(terrain.width_m(), terrain.depth_m());
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  for (int axis = 0; axis < 2; ++axis) {
    Eigen::Vector2d before = p_W, after = p_W;
    before[axis] = std::max(p_W[axis] - kReach_m, low[axis]);
    after[axis] = std::min(p_W[axis] + kReach_m, high[axis]);
    normal_W[axis] =
        (terrain.height_m(before.x(), before.y()) - terrain.height_m(after.x(), after.y())) /
        (after[axis] - before[axis]);
  }
  normal_W.normalize();
  const Eigen::Vector3d ground_W(p_W.x(), p_W.y(), terrain.height_m(p_W.x(), p_W.y()));
  return {normal_W, normal_W.dot(ground_W), 0.0};
}

std::optional<GroundPlane> RowGround::at(const Eigen::Vector3d& p_W) const {
  if (terrain_ && terrain_->contains(p_W.x(), p_W.y())) return on_terrain(p_W.head<2>());
  const Eigen::Vector2d p = p_W.head<2>();
  const auto [nearest, next] = index_.nearest_two(p);
  if (next.line < 0) return std::nullopt;
  const auto in_space = [&](const PolylineIndex::Nearest& at) {
    return nearest_from_above(std::span(lines_W_[at.line]).subspan(at.segment, 2), p);
  };
  const LinePoint first = in_space(nearest), second = in_space(next);
  Eigen::Vector3d normal_W = first.edge.cross(second.p - first.p);
  if (std::abs(normal_W.z()) < 1e-6) return std::nullopt;
  normal_W *= std::copysign(1.0, normal_W.z()) / normal_W.norm();
  const std::array across = {first.p, second.p};
  return GroundPlane{normal_W, normal_W.dot(first.p), nearest_from_above(across, p).distance_m};
}

namespace {

/// Angle between the plane's downward normal and the nearest ray of the cone.
double nearest_ray_rad(const GroundPlane& ground, const Eigen::Vector3d& dir_W,
                       double half_angle_rad) {
  const double off_rad = std::acos(std::clamp(-ground.normal_W.dot(dir_W), -1.0, 1.0));
  return std::max(0.0, off_rad - half_angle_rad);
}

}  // namespace

std::optional<double> plane_distance_m(const GroundPlane& ground, const Eigen::Vector3d& dir_W,
                                       double half_angle_rad, double range_m) {
  // The nearest point of the plane is on its normal if the cone contains the normal.
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

}  // namespace vinerow::controllers
