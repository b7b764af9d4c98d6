#pragma once
/// The ground between mapped rows, as a plane: what a rangefinder that looks down sees.

#include <Eigen/Core>
#include <optional>

#include "engine/api/map.h"

namespace vinerow {

/// n.x = offset_m, n unit and upwards.
struct GroundPlane {
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  double offset_m = 0.0;
};

/// Through the nearest piece of the nearest row's line and the nearest point of the next row's.
/// @returns nothing where the map has fewer than two rows, or they meet there
std::optional<GroundPlane> find_ground(const RowMap& map, const Eigen::Vector3d& p_W);

/// Distance from the sensor to the plane, at a right angle to it, of an echo that is the first
/// return in a cone.
/// @param dir_W  the cone's axis, unit, towards the plane
/// @returns nothing where the cone looks past it
std::optional<double> plane_distance_m(const GroundPlane& ground, const Eigen::Vector3d& dir_W,
                                       double half_angle_rad, double range_m);

}  // namespace vinerow
