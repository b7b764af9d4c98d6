#pragma once
/// Controller `quadrotor_pid`: the usual cascade of autopilots, a baseline for optimal control.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec quadrotor_pid_spec();

/// @throws ConfigError if the vehicle has no rotors or cannot hover
std::unique_ptr<Controller> make_quadrotor_pid(const ParameterSet& parameters,
                                               const ControllerContext& context);

}  // namespace vinerow::controllers
