#pragma once
/// A cheap proof that a body does not touch the height field, so that the narrow phase, which tests
/// the body against every triangle under its bounding box, need not run: on a slope the box of a
/// vehicle reaches into the hill although the vehicle stands well clear of it.

#include <btBulletCollisionCommon.h>

#include "engine/api/forward.h"

namespace vinerow::physics {

/// The body lies above the plane through its lowest point, square to its z axis. Where all samples
/// of the terrain under its bounding box lie below that plane, so do the triangles between them.
/// @param margin_m  that must be left between plane and samples
/// @returns true if the body is clear; false if this test cannot tell
bool is_clear_of_terrain(const HeightField& terrain, const btCollisionObject& body,
                         double margin_m);

}  // namespace vinerow::physics
