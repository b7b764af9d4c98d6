#pragma once
/// Controller `quadrotor_lqr`: the unconstrained optimum about hover, a baseline for predictive
/// control.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec quadrotor_lqr_spec();

/// @throws ConfigError if the vehicle has no rotors or cannot hover, or the weights give no gain
std::unique_ptr<Controller> make_quadrotor_lqr(const ParameterSet& parameters,
                                               const ControllerContext& context);

}  // namespace vinerow::controllers
