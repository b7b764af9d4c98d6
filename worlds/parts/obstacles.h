#pragma once
/// Obstacles of a world: boxes that the map may or may not contain.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/parameter_table_fwd.h"

namespace vinerow::worlds {

/// Box at x, y or in an alley.
struct ObstacleParams {
  std::string name;  ///< empty: its number in the list
  std::optional<double> x_m, y_m;
  std::optional<std::int64_t> alley;
  double distance_m = 0.0;  ///< along the alley's centre line from its first point
  double lateral_m = 0.0;   ///< to the left of that line
  double yaw_rad = 0.0;     ///< of the length: from east, in an alley from the alley's direction
  Eigen::Vector3d size_m = {0.6, 0.4, 0.6};  ///< length, width, height
  bool mapped = false;                       ///< true if it is in the occupancy grid
};

struct ObstaclesParams {
  std::vector<ObstacleParams> list;
};
/// `obstacles`: list of {name, x_m, y_m | alley, distance_m, lateral_m; yaw_deg, size_m, mapped}.
const ParameterTable<ObstaclesParams>& obstacles_table();

/// Appends the boxes, each upright on the slope of the ground under it: "obstacle/<name>" collides
/// and is class kObstacle, "crate/<name>" is drawn.
/// @param world  with terrain and alleys
/// @returns plan outlines (four corners, W) of those with `mapped: true`
/// @throws ConfigError naming the obstacle: no or two positions, unknown alley, off the terrain, a
/// name that is used twice
std::vector<std::vector<Eigen::Vector2d>> place_obstacles(const ObstaclesParams& params,
                                                          WorldModel& world);

}  // namespace vinerow::worlds
