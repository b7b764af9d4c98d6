#pragma once
/// Transformation of a map from its own local frame to that of a world.

#include <string>
#include <vector>

#include "worlds/mapping/model/cloud_map.h"

namespace vinerow::mapping {

/// Moves a map to the local East-North-Up frame of another origin. Lines, boundary and meshes are
/// rotated and shifted by the transformation between the two frames on the ellipsoid. The terrain
/// is resampled at its own cell. The occupancy grid is shifted; if the rotation would displace its
/// rim by a quarter of a cell, it is resampled. Equal origins change nothing.
/// @pre map.has_origin
void move_map(const GeoOrigin& to, CloudMap& map);

/// Horizontal distance of two blocks, between the boxes around their rows, m; 0 if the boxes
/// overlap. @pre both have rows
double distance_between_m(const std::vector<PlantRow>& a, const std::vector<PlantRow>& b);

}  // namespace vinerow::mapping
