#pragma once
/// Guidance `dwa`: local planning of a four-wheel-steering vehicle by the dynamic window approach,
/// with what ultrasonic rangers see beside the map. Laws: dwa_law.h, obstacle_memory.h.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::controllers {

PartSpec dwa_spec();
/// @throws ConfigError for a vehicle without steered axles (SteeredVehicle) or max_speed_mps, or
/// circles that do not hold its outline
std::unique_ptr<Guidance> make_dwa(const ParameterSet& parameters,
                                   const ControllerContext& context);

}  // namespace vinerow::controllers
