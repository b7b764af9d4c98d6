#pragma once
/// The line of a row or an alley of a map, seen from above.

#include <Eigen/Core>
#include <limits>
#include <span>

namespace vinerow::controllers {

/// A point on such a line.
struct LinePoint {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d edge_W = Eigen::Vector3d::UnitX();  ///< the piece it lies on, m, not unit
  double distance_m = std::numeric_limits<double>::infinity();  ///< seen from above
};

/// The nearest one of a single piece.
/// @returns a distance of +infinity where the piece has no length
LinePoint nearest_on_piece(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                           const Eigen::Vector3d& p_W);

/// The nearest one, seen from above; of equals the first.
/// @returns a distance of +infinity where the line has no piece of any length
LinePoint nearest_on(std::span<const Eigen::Vector3d> line_W, const Eigen::Vector3d& p_W);

}  // namespace vinerow::controllers
