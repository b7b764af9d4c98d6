#pragma once
/// Obstacles of a world: boxes, and things from mesh files, that the map may or may not contain.

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/api/surface.h"

namespace vinerow::worlds {

/// Box or mesh at x, y or in an alley.
struct ObstacleParams {
  std::string name;  ///< empty: its number in the list
  std::optional<double> x_m, y_m;
  std::optional<std::int64_t> alley;
  double distance_m = 0.0;  ///< along the alley's centre line from its first point
  double lateral_m = 0.0;   ///< to the left of that line
  double yaw_rad = 0.0;     ///< of the length: from east, in an alley from the alley's direction
  std::optional<Eigen::Vector3d> size_m;  ///< length, width, height
  std::filesystem::path file;             ///< mesh that is drawn; empty: a crate
  std::optional<Label> label;             ///< for cameras
  bool mapped = false;                    ///< true if it is in the occupancy grid
};

struct ObstaclesParams {
  std::vector<ObstacleParams> list;
};
/// `obstacles`: list of {name, x_m, y_m | alley, distance_m, lateral_m; yaw_deg, size_m | file,
/// label, mapped}.
const ParameterTable<ObstaclesParams>& obstacles_table();

/// Appends "obstacle/<name>", a box of class kObstacle that collides, and "crate/<name>" or the
/// meshes of the file, which are drawn and which light meets. Boxes stand on the slope of the
/// ground under them. Meshes stand upright with their z = 0 on the ground; their box is their
/// extent.
/// @param world  with terrain and alleys
/// @returns plan outlines (four corners, W) of those with `mapped: true`
/// @throws ConfigError naming the obstacle: no or two positions, unknown alley, off the terrain, a
/// name that is used twice, a size besides a file, a file that cannot be loaded
std::vector<std::vector<Eigen::Vector2d>> place_obstacles(const ObstaclesParams& params,
                                                          WorldModel& world);

}  // namespace vinerow::worlds
