#pragma once
/// Ground of a map of rows as a local plane, for rangefinders that look down and for wheels. It
/// comes from the map's terrain or, without one, from the rows' lines.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/api/map.h"
#include "engine/math/polyline_index.h"

namespace vinerow::controllers {

/// n.x = offset_m, n unit and upwards.
struct GroundPlane {
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  double offset_m = 0.0;
  double away_m = 0.0;  ///< horizontal distance from the strip between the two rows; 0 in an alley
                        ///< and on a terrain
};

class RowGround {
 public:
  /// Copies the terrain and the rows' lines.
  explicit RowGround(const RowMap& map);

  /// On the terrain: the plane through the ground below, with the slope of the ground over the
  /// length of a vehicle. Elsewhere: the plane through the nearest segment of the nearest row's
  /// line and the nearest point of the second nearest row's line.
  /// @returns nullopt if the map has fewer than two rows, or if the plane is undefined or vertical
  std::optional<GroundPlane> at(const Eigen::Vector3d& p_W) const;

 private:
  GroundPlane on_terrain(const Eigen::Vector2d& p_W) const;

  std::optional<HeightField> terrain_;
  std::vector<std::vector<Eigen::Vector3d>> lines_W_;
  PolylineIndex index_;
};

/// Perpendicular distance from the sensor to the plane for an echo that is the first return in a
/// cone.
/// @param dir_W  the cone's axis, unit, towards the plane
/// @returns nullopt if the cone misses the plane
std::optional<double> plane_distance_m(const GroundPlane& ground, const Eigen::Vector3d& dir_W,
                                       double half_angle_rad, double range_m);

/// Distance from a sensor at sensor_W to the nearest point of the plane in its cone.
/// @param dir_W  the cone's axis, unit
/// @returns nullopt if the cone misses the plane; 0 for a sensor below it
std::optional<double> nearest_in_cone_m(const GroundPlane& ground, const Eigen::Vector3d& sensor_W,
                                        const Eigen::Vector3d& dir_W, double half_angle_rad);

}  // namespace vinerow::controllers
