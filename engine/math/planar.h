#pragma once
/// Vectors in the horizontal plane.

#include <Eigen/Core>

namespace vinerow {

/// The vector rotated by 90 degrees to the left.
inline Eigen::Vector2d left_of(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

/// z component of the cross product: positive if b points to the left of a.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace vinerow
