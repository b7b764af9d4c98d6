#pragma once
/// Where vehicles stand at the start, and whether they stand free there.

#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/math/pose.h"
#include "engine/scenario/scenario.h"

namespace vinerow {

/// How a world gets more ground, for the end of a refusal: "; a larger world.surroundings_m (6 m
/// now) makes more of it" where it has that key.
std::string tell_more_ground(const ParameterSet& world);

/// Pose of a vehicle at the start, standing on the ground: the highest terrain there, or where the
/// world has none the highest obstacle. It is tilted as the ground is a wheel base around; what
/// stands on the ground, or rises steeper than 45 deg, tilts nothing.
/// @throws ConfigError naming what the world has, if the alley or spawn point is unknown; or that
/// there is no ground
/// @param remedy  what that ends with
Pose find_spawn_pose(const scenario::SpawnConfig& spawn, const WorldModel& world,
                     const SceneQuery& scene, const std::string& vehicle,
                     double height_above_ground_m, const std::string& remedy = "");

/// The room that a vehicle takes at the start: its collision box, widened to its outline, and down
/// to its wheels where it has some.
struct StartBox {
  std::string vehicle;
  Pose X_WC;  ///< of the box's centre
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();
};
StartBox find_start_box(const std::string& vehicle, const Pose& X_WB,
                        const VehicleDescription& description);

/// @param others  vehicles that stand there already
/// @throws ConfigError "scenario.yaml:7: vehicles.rover.spawn: at x = 3.000 m, y = 2.000 m the
/// vehicle would stand in the canopy 'row_2'; ..."
void refuse_start_in_contact(const scenario::SpawnConfig& spawn, const StartBox& box,
                             const std::vector<StartBox>& others, const WorldModel& world,
                             const SceneQuery& scene);

}  // namespace vinerow
