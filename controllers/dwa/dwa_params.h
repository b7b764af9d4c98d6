#pragma once
/// Parameters of guidance `dwa` as files name them.

#include "controllers/dwa/dwa_guide.h"
#include "engine/api/stepped_parts.h"

namespace vinerow {

std::vector<ParameterSpec> dwa_parameters();

/// @throws ConfigError "rover.guidance (dwa) needs 'front_axle_m', which vehicle type 'x' does not
/// tell (it tells: ...)", or crossed limits with their numbers
DwaGuideParams read_dwa_params(const ParameterSet& parameters, const ControllerContext& context);
/// @throws ConfigError if the circles leave more of the outline uncovered than margin_m
DiscOutline read_dwa_outline(const ParameterSet& parameters, const ControllerContext& context);
ObstacleMemoryParams read_obstacle_memory_params(const ParameterSet& parameters);

}  // namespace vinerow
