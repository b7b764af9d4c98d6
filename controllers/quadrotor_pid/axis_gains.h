#pragma once
/// Gains of three axes from parameters with two values.

#include <Eigen/Core>

namespace vinerow::controllers {

/// (horizontal, vertical) or (about x and y, about z) for the axes x, y, z.
inline Eigen::Vector3d spread(const Eigen::Vector2d& gains) {
  return {gains.x(), gains.x(), gains.y()};
}

}  // namespace vinerow::controllers
