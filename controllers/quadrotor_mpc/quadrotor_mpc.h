#pragma once
/// Controller `quadrotor_mpc`: linear model predictive control of paper A, section 4.2. It fills
/// the paper's gaps and removes its offset under wind by a disturbance observer.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec quadrotor_mpc_spec();

/// @throws ConfigError if the vehicle is no rotorcraft, or its rotors cannot hover or lack a lag
std::unique_ptr<Controller> make_quadrotor_mpc(const ParameterSet& parameters,
                                               const ControllerContext& context);

}  // namespace vinerow::controllers
