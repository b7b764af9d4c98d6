#pragma once
/// A wooden crate: what an obstacle looks like.

#include <Eigen/Core>

#include "engine/api/mesh.h"

namespace vinerow::worlds {

/// A plain closed box, foot in the plane z = -foot_m, centred over the origin. @param size_m length
/// along x, width along y, height above z = 0
TriangleMesh make_box(const Eigen::Vector3d& size_m, double foot_m);

/// The same box in upright boards with frames at top and bottom and a lid. Nothing stands out of
/// the plain box. In vertex colours.
TriangleMesh make_crate(const Eigen::Vector3d& size_m, double foot_m);

}  // namespace vinerow::worlds
