#pragma once
/// Exact distance between two boxes, in double precision.

#include <Eigen/Core>

#include "engine/math/pose.h"

namespace vinerow::physics {

/// Smallest distance between two solid boxes, 0 if they touch or overlap, m. No heap.
///
/// The smallest distance between convex polyhedra is between a corner of one and the other, or
/// between two edges. If they overlap, an edge of one passes through the other or is inside it. In
/// every case it is a distance between an edge of one box and the other solid box: 24 distances of
/// a segment and a box.
/// @param X_WA,X_WB        poses of the boxes' centres
/// @param half_extents_A,half_extents_B  half lengths along their own axes, m, not negative
double box_distance_m(const Pose& X_WA, const Eigen::Vector3d& half_extents_A, const Pose& X_WB,
                      const Eigen::Vector3d& half_extents_B);

}  // namespace vinerow::physics
