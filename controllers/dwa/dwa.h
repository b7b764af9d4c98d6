#pragma once
/// Guidance `dwa`: local planning of a four-wheel-steering vehicle by the dynamic window approach,
/// with obstacles that ultrasonic rangers detect and the map lacks. Laws: dwa_law.h,
/// obstacle_memory.h.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::controllers {

PartSpec dwa_spec();
/// @throws ConfigError for a vehicle without steered axles (SteeredVehicle) or max_speed_mps, or
/// if the circles do not contain its outline
std::unique_ptr<Guidance> make_dwa(const ParameterSet& parameters,
                                   const ControllerContext& context);

}  // namespace vinerow::controllers
