#pragma once
/// Directions of rangefinders as autopilots know them.

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

}  // namespace vinerow::controllers
