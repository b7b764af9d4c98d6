#pragma once
/// Nearest points on the line of a row or an alley, seen from above.

#include <Eigen/Core>
#include <limits>
#include <span>

namespace vinerow::controllers {

/// A point on a line.
struct LinePoint {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d edge_W = Eigen::Vector3d::UnitX();  ///< the segment that contains it, m, not unit
  double distance_m = std::numeric_limits<double>::infinity();  ///< seen from above
};

/// Nearest point of a single segment. @returns a distance of +infinity if the segment has no length
LinePoint nearest_on_piece(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                           const Eigen::Vector3d& p_W);

/// Nearest point of a line; the first among equals. @returns a distance of +infinity if no segment
/// of the line has any length
LinePoint nearest_on(std::span<const Eigen::Vector3d> line_W, const Eigen::Vector3d& p_W);

}  // namespace vinerow::controllers
