#pragma once
/// Ground on which things are placed. It is the terrain or, at places without terrain, obstacles,
/// for worlds whose files do not distinguish the ground. Objects on the terrain are not ground.

#include <optional>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"

namespace vinerow {

class PlacementGround {
 public:
  /// @param world,scene  outlive this object
  PlacementGround(const WorldModel& world, const SceneQuery& scene);

  /// Height of the highest ground at a place. @returns nullopt if there is no ground
  std::optional<double> height_m(double x, double y) const;
  /// True if the place has no terrain, so that obstacles are its ground.
  bool takes_obstacles(double x, double y) const { return !terrain_m(x, y, kFromAbove_m); }
  /// Height of the ground at (x, y) that a wheel could stand on, near a placed vehicle. Walls,
  /// crowns and roofs, which differ in height by more than 45 deg, do not count.
  /// @param here_m  height of the ground at the vehicle
  /// @param obstacles  true if obstacles are ground at the vehicle
  /// @param distance_m  horizontal distance of (x, y) from the vehicle
  std::optional<double> height_near_m(double x, double y, double here_m, bool obstacles,
                                      double distance_m) const;

 private:
  static constexpr double kFromAbove_m = 2e4;  ///< higher than any ground
  std::optional<double> terrain_m(double x, double y, double z_from) const;

  const WorldModel& world_;
  const SceneQuery& scene_;
  bool has_terrain_mesh_ = false;
};

}  // namespace vinerow
