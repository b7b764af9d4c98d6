#pragma once
/// Controller `quadrotor_mpc`: linear model predictive control of paper A, section 4.2, with the
/// paper's gaps filled and its offset under wind removed by a disturbance observer.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec quadrotor_mpc_spec();

/// @throws ConfigError if the vehicle is no rotorcraft, or its rotors cannot hover or do not lag
std::unique_ptr<Controller> make_quadrotor_mpc(const ParameterSet& parameters,
                                               const ControllerContext& context);

}  // namespace vinerow::controllers
