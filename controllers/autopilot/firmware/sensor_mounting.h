#pragma once
/// How a vehicle's sensors are mounted, as autopilots need it.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// MAV_SENSOR_ORIENTATION of a mounted sensor: steps of 45 degrees to the right from 0 (forward),
/// 24 up, 25 down. @returns nullopt if the vehicle has no such sensor
std::optional<std::uint8_t> range_orientation(const std::string& sensor,
                                              const std::vector<SensorMounting>& mountings);

/// Rotation from a sensor's frame to B. Autopilots take inertial readings and the magnetic field in
/// the body, however the sensor is mounted. @returns the identity for a sensor without a mounting
Eigen::Quaterniond q_BS_of(const std::string& sensor, const std::vector<SensorMounting>& mountings);

}  // namespace vinerow::controllers
