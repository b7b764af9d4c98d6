#pragma once
/// The ground between mapped rows, as a plane: what a rangefinder that looks down sees, and what
/// wheels roll on.

#include <Eigen/Core>
#include <optional>

#include "controllers/estimation/row_line_index.h"
#include "engine/api/map.h"

namespace vinerow {

/// n.x = offset_m, n unit and upwards.
struct GroundPlane {
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  double offset_m = 0.0;
  double away_m = 0.0;  ///< from the strip between the two rows, seen from above: 0 in an alley
};

class RowGround {
 public:
  /// Copies the rows' lines.
  explicit RowGround(const RowMap& map) : lines_(map) {}

  /// Through the nearest piece of the nearest row's line and the nearest point of the next row's.
  /// @returns nothing where the map has fewer than two rows, or they meet there
  std::optional<GroundPlane> at(const Eigen::Vector3d& p_W) const;

 private:
  RowLineIndex lines_;
};

/// Distance from the sensor to the plane, at a right angle to it, of an echo that is the first
/// return in a cone.
/// @param dir_W  the cone's axis, unit, towards the plane
/// @returns nothing where the cone looks past it
std::optional<double> plane_distance_m(const GroundPlane& ground, const Eigen::Vector3d& dir_W,
                                       double half_angle_rad, double range_m);

/// Distance from a sensor at sensor_W to the nearest point of the plane in its cone.
/// @param dir_W  the cone's axis, unit
/// @returns nothing where the cone looks past it; 0 for a sensor below it
std::optional<double> nearest_in_cone_m(const GroundPlane& ground, const Eigen::Vector3d& sensor_W,
                                        const Eigen::Vector3d& dir_W, double half_angle_rad);

}  // namespace vinerow
