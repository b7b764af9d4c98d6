#pragma once
/// Cheap proof that a body does not touch the height field. It saves the narrow phase, which tests
/// the body against every triangle under its bounding box: on a slope the box of a vehicle reaches
/// into the hill although the vehicle is well clear of it.

#include <btBulletCollisionCommon.h>

#include "engine/api/forward.h"

namespace vinerow::physics {

/// The body is above the plane through its lowest point, perpendicular to its z axis. If all
/// terrain samples under its bounding box are below that plane, so are the triangles between them.
/// @param margin_m  required gap between plane and samples
/// @returns true if the body is clear; false if this test cannot decide
bool is_clear_of_terrain(const HeightField& terrain, const btCollisionObject& body,
                         double margin_m);

}  // namespace vinerow::physics
