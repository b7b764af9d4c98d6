#pragma once
/// Brings a map from its own local frame to a world's.

#include <string>
#include <vector>

#include "worlds/mapping/model/cloud_map.h"

namespace vinerow::mapping {

/// Moves everything of a map to the local East-North-Up frame of another origin. Lines, boundary
/// and meshes are turned and shifted as the two frames lie to each other on the ellipsoid; the
/// terrain is sampled anew at its own cell; the occupancy grid is shifted, and drawn anew where the
/// frames are turned against each other so much that its rim would be off by a quarter of a cell.
/// Equal origins change nothing.
/// @pre map.has_origin
void move_map(const GeoOrigin& to, CloudMap& map);

/// How far apart two blocks are: between the boxes around their rows, horizontally, m; 0 where the
/// boxes overlap. @pre both have rows
double distance_between_m(const std::vector<PlantRow>& a, const std::vector<PlantRow>& b);

}  // namespace vinerow::mapping
