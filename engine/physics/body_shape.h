#pragma once
/// Bullet shapes from the shapes of a BodySpec. Only used inside this folder.

#include <btBulletCollisionCommon.h>

#include <memory>
#include <string>
#include <vector>

#include "engine/physics/physics_world.h"

namespace vinerow::physics {

/// Shape of a whole body in frame P, and its components; `parts.back()` is the one to use.
/// @param q_BP  orientation of P in B; both have their origin at the centre of mass
/// @returns no parts if the body has no shapes
/// @throws ConfigError "body 'rover': radius_m = -1, must be > 0"
std::vector<std::unique_ptr<btCollisionShape>> make_body_shape(
    const std::string& body_name, const std::vector<PlacedShape>& shapes,
    const Eigen::Quaterniond& q_BP);

}  // namespace vinerow::physics
