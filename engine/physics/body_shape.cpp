#include "engine/physics/body_shape.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/physics/bullet_convert.h"

namespace vinerow::physics {
namespace {

// Bullet enlarges a hull by its margin. 1 mm is chosen: negligible as a geometry error, but enough
// for the narrow phase to work without its slower penetration search.
constexpr double kHullMargin_m = 0.001;

struct ShapeMaker {
  const std::string& body_name;

  double positive(double value, const char* key) const {
    if (!(value > 0.0) || !std::isfinite(value)) {
      throw ConfigError(fmt::format("body '{}': {} = {}, must be > 0", body_name, key, value));
    }
    return value;
  }
  std::unique_ptr<btCollisionShape> operator()(const NoShape&) const { return nullptr; }
  std::unique_ptr<btCollisionShape> operator()(const BoxShape& box) const {
    for (const double half : box.half_extents_m) positive(half, "half_extents_m");
    return std::make_unique<btBoxShape>(to_bullet(box.half_extents_m));
  }
  std::unique_ptr<btCollisionShape> operator()(const SphereShape& sphere) const {
    return std::make_unique<btSphereShape>(positive(sphere.radius_m, "radius_m"));
  }
  std::unique_ptr<btCollisionShape> operator()(const CylinderShape& cylinder) const {
    const double radius_m = positive(cylinder.radius_m, "radius_m");
    return std::make_unique<btCylinderShape>(
        btVector3(radius_m, positive(cylinder.half_width_m, "half_width_m"), radius_m));
  }
  std::unique_ptr<btCollisionShape> operator()(const HullShape& hull) const {
    if (hull.points_B.size() < 4) {
      throw ConfigError(fmt::format("body '{}': hull has {} points, must be 4 or more", body_name,
                                    hull.points_B.size()));
    }
    auto shape = std::make_unique<btConvexHullShape>();
    for (const Eigen::Vector3d& point : hull.points_B) {
      if (!point.allFinite()) {
        throw ConfigError(fmt::format("body '{}': a point of its hull is not finite", body_name));
      }
      shape->addPoint(to_bullet(point), false);
    }
    shape->recalcLocalAabb();
    shape->setMargin(kHullMargin_m);
    return shape;
  }
};

}  // namespace

std::vector<std::unique_ptr<btCollisionShape>> make_body_shape(
    const std::string& body_name, const std::vector<PlacedShape>& shapes,
    const Eigen::Quaterniond& q_BP) {
  std::vector<std::unique_ptr<btCollisionShape>> parts;
  std::vector<Pose> X_PS;
  const Pose X_PB = Pose{q_BP, Eigen::Vector3d::Zero()}.inverse();
  for (const PlacedShape& placed : shapes) {
    std::unique_ptr<btCollisionShape> part = std::visit(ShapeMaker{body_name}, placed.shape);
    if (!part) continue;
    parts.push_back(std::move(part));
    X_PS.push_back(X_PB * placed.X_BS);
  }
  if (parts.empty()) return parts;
  const bool in_place =
      X_PS[0].p.isZero(0.0) && X_PS[0].q.isApprox(Eigen::Quaterniond::Identity(), 0.0);
  if (parts.size() == 1 && in_place) return parts;

  auto whole = std::make_unique<btCompoundShape>(true, static_cast<int>(parts.size()));
  for (std::size_t i = 0; i < X_PS.size(); ++i) {
    whole->addChildShape(to_bullet(X_PS[i]), parts[i].get());
  }
  parts.push_back(std::move(whole));
  return parts;
}

}  // namespace vinerow::physics
