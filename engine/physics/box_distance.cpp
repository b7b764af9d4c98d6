#include "engine/physics/box_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/physics/triangle_box.h"

namespace vinerow::physics {
namespace {

/// Smallest squared distance from the edges of box A to the solid box B.
double edges_distance2(const Pose& X_BA, const Eigen::Vector3d& half_A,
                       const Eigen::Vector3d& half_B) {
  const Eigen::Matrix3d half_axes_B = X_BA.q.toRotationMatrix() * half_A.asDiagonal();
  double min_distance2 = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = half_axes_B.col(axis);
    const Eigen::Vector3d u = half_axes_B.col((axis + 1) % 3), v = half_axes_B.col((axis + 2) % 3);
    for (const double side : {-1.0, 1.0}) {
      for (const double other : {-1.0, 1.0}) {
        const Eigen::Vector3d middle = X_BA.p + side * u + other * v;
        min_distance2 =
            std::min(min_distance2, segment_box_distance2(middle - along, middle + along, half_B));
      }
    }
  }
  return min_distance2;
}

}  // namespace

double box_distance_m(const Pose& X_WA, const Eigen::Vector3d& half_extents_A, const Pose& X_WB,
                      const Eigen::Vector3d& half_extents_B) {
  const Pose X_BA = X_WB.inverse() * X_WA;
  const double from_A = edges_distance2(X_BA, half_extents_A, half_extents_B);
  if (from_A == 0.0) return 0.0;
  return std::sqrt(
      std::min(from_A, edges_distance2(X_BA.inverse(), half_extents_B, half_extents_A)));
}

}  // namespace vinerow::physics
