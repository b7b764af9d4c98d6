#pragma once
/// What viewers of a log see beside its signals: ground, rows, posts, wires and vehicles as solid
/// things, and where each sensor sits.

#include <map>
#include <string>
#include <vector>

#include "engine/record/scene_message.h"
#include "engine/sim/simulation.h"

namespace vinerow::playback {

/// Bounds of a scene: a log that is many times larger for its decoration would help nobody.
struct SceneLimits {
  std::size_t ground_samples = 12'000;  ///< about; half of them around the rows
  std::size_t canopy_points = 40'000;   ///< more than that: rows are drawn as boxes
  std::size_t solid_points = 40'000;    ///< of posts, trunks, wires and obstacles together
  std::size_t vehicle_points = 40'000;  ///< of each vehicle; a link beyond that is a box
};

/// Ground and what stands on it, in frame "map". Of what exceeds its limit the dearest is left out
/// first: trunks, then wires, posts, obstacles.
std::vector<record::SceneEntity> world_scene(const WorldModel& world,
                                             const SceneLimits& limits = {});

/// The links of a vehicle, each in its own frame "<vehicle>/<link>", which moves with the log.
std::vector<record::SceneEntity> vehicle_scene(const std::string& vehicle,
                                               const std::vector<VehicleLink>& links,
                                               const SceneLimits& limits = {});

/// Frame of a sensor in a log: "rover/lidar", or "rover/lidar_sensor" where a link of the vehicle
/// has that name.
std::string sensor_frame(const std::string& vehicle, const std::string& sensor,
                         const std::vector<VehicleLink>& links);

/// Where the sensors of all vehicles sit. @pre the vehicles' parts were built once
std::vector<record::StaticTransform> sensor_transforms(const Simulation& simulation);

/// Frame of a sensor's readings, and of what it would have read without error, by signal.
std::map<std::string, std::string> frames_of_readings(const Simulation& simulation);

}  // namespace vinerow::playback
