#pragma once
/// Poses of vehicles at the start, and the check that these places are free.

#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/math/pose.h"
#include "engine/scenario/scenario.h"

namespace vinerow {

/// Hint on how to get more ground, for the end of an error message: "; increase
/// world.surroundings_m (6 m now) to extend it" if the world has that key.
std::string larger_ground_hint(const ParameterSet& world);

/// Pose of a vehicle at the start, on the ground: on the highest terrain there or, if the place has
/// no terrain, on the highest obstacle. The vehicle is tilted like the ground 0.5 m around it.
/// Objects on the ground, and ground that rises by more than 45 deg, do not tilt it.
/// @param remedy  end of the message if there is no ground
/// @throws ConfigError if the alley or spawn point is unknown (with those that exist), or if there
/// is no ground
Pose find_spawn_pose(const scenario::SpawnConfig& spawn, const WorldModel& world,
                     const SceneQuery& scene, const std::string& vehicle,
                     double height_above_ground_m, const std::string& remedy = "");

/// Space that a vehicle occupies at the start: its collision box, extended to its outline and, for
/// wheeled vehicles, down to its wheels.
struct StartBox {
  std::string vehicle;
  Pose X_WC;  ///< of the box's centre
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();
};
StartBox find_start_box(const std::string& vehicle, const Pose& X_WB,
                        const VehicleDescription& description);

/// Checks that the space of a vehicle is free. @param others  vehicles that are already placed
/// @throws ConfigError "scenario.yaml:7: vehicles.rover.spawn: at x = 3.000 m, y = 2.000 m the
/// vehicle would stand in the canopy 'row_2'; ..."
void refuse_start_in_contact(const scenario::SpawnConfig& spawn, const StartBox& box,
                             const std::vector<StartBox>& others, const WorldModel& world,
                             const SceneQuery& scene);

}  // namespace vinerow
