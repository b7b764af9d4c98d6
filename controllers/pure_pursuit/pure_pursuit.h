#pragma once
/// Controller `pure_pursuit`: paper B's follower for a speed-steered vehicle.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec pure_pursuit_spec();

/// @throws ConfigError if the vehicle has no left and right wheel speeds
std::unique_ptr<Controller> make_pure_pursuit(const ParameterSet& parameters,
                                              const ControllerContext& context);

}  // namespace vinerow::controllers
