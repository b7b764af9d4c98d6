#pragma once
/// Boxes that stand in a world's way: an obstacle that the map need not know.

#include <Eigen/Core>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/parameters.h"

namespace vinerow::worlds {

/// `obstacles`: list of {name, x_m, y_m | alley, distance_m, lateral_m; yaw_deg, size_m, mapped}.
std::vector<ParameterSpec> obstacle_parameters();

/// Appends the boxes, each upright on the slope of the ground under it: "obstacle/<name>" collides
/// and is class kObstacle, "crate/<name>" is drawn.
/// @param world  with terrain and alleys
/// @returns the plans (four corners, W) of those with `mapped: true`
/// @throws ConfigError naming the obstacle: no or two positions, unknown alley, off the terrain, a
/// name that stands twice
std::vector<std::vector<Eigen::Vector2d>> place_obstacles(const ParameterSet& parameters,
                                                          WorldModel& world);

}  // namespace vinerow::worlds
