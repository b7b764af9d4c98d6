#pragma once
/// Meshes of a wooden crate, for obstacles.

#include <Eigen/Core>

#include "engine/api/mesh.h"

namespace vinerow::worlds {

/// Plain closed box, base in the plane z = -foot_m, centred over the origin. @param size_m length
/// along x, width along y, height above z = 0
TriangleMesh make_box(const Eigen::Vector3d& size_m, double foot_m);

/// The same box as upright boards with frames at top and bottom and a lid, inside the plain box,
/// with vertex colours.
TriangleMesh make_crate(const Eigen::Vector3d& size_m, double foot_m);

}  // namespace vinerow::worlds
