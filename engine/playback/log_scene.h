#pragma once
/// Scene of a log for viewers: ground, rows, posts, wires and vehicles as solids, and the
/// mountings of the sensors.

#include <map>
#include <string>
#include <vector>

#include "engine/record/scene_message.h"
#include "engine/sim/simulation.h"

namespace vinerow::playback {

/// Limits on the size of a scene, so that it does not dominate the size of the log.
struct SceneLimits {
  std::size_t ground_samples = 12'000;  ///< approximate; half of them around the rows
  std::size_t canopy_points = 40'000;   ///< if exceeded, rows are drawn as boxes
  std::size_t solid_points = 40'000;    ///< of posts, trunks, wires and obstacles together
  std::size_t vehicle_points = 40'000;  ///< of each vehicle; further links are drawn as boxes
};

/// Ground and the objects on it, in frame "map". If they exceed the limit, the most expensive
/// classes are left out first: trunks, then wires, posts, obstacles.
std::vector<record::SceneEntity> world_scene(const WorldModel& world,
                                             const SceneLimits& limits = {});

/// Links of a vehicle, each in its own frame "<vehicle>/<link>", which moves with the log.
std::vector<record::SceneEntity> vehicle_scene(const std::string& vehicle,
                                               const std::vector<VehicleLink>& links,
                                               const SceneLimits& limits = {});

/// Frame of a sensor in a log: "rover/lidar", or "rover/lidar_sensor" if a link of the vehicle has
/// the sensor's name.
std::string sensor_frame(const std::string& vehicle, const std::string& sensor,
                         const std::vector<VehicleLink>& links);

/// Mountings of the sensors of all vehicles. @pre the vehicles' parts were built once
std::vector<record::StaticTransform> sensor_transforms(const Simulation& simulation);

/// Frames of the signals of sensors' readings, of their error-free readings, and of what is
/// computed from them (SignalBase::frame_source()), by signal.
std::map<std::string, std::string> frames_of_readings(const Simulation& simulation);

}  // namespace vinerow::playback
