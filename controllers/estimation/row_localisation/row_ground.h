#pragma once
/// The ground of a map of rows, as a plane: what a rangefinder that looks down sees, and what
/// wheels roll on. Maps that have a terrain tell it there; of others the rows' lines do.

#include <Eigen/Core>
#include <optional>

#include "controllers/estimation/row_localisation/row_line_index.h"
#include "engine/api/map.h"

namespace vinerow::controllers {

/// n.x = offset_m, n unit and upwards.
struct GroundPlane {
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  double offset_m = 0.0;
  double away_m = 0.0;  ///< from where the map knows the ground, seen from above: its terrain, or
                        ///< the strip between the two rows; 0 in an alley
};

class RowGround {
 public:
  /// Copies the terrain and the rows' lines.
  explicit RowGround(const RowMap& map) : terrain_(map.terrain), lines_(map) {}

  /// On the terrain the plane through the ground below, as steep as the ground is over the length
  /// of a vehicle. Elsewhere through the nearest piece of the nearest row's line and the nearest
  /// point of the next row's.
  /// @returns nothing where the map has fewer than two rows, or they meet there
  std::optional<GroundPlane> at(const Eigen::Vector3d& p_W) const;

 private:
  GroundPlane on_terrain(const Eigen::Vector2d& p_W) const;

  std::optional<HeightField> terrain_;
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

}  // namespace vinerow::controllers
