#pragma once
/// Controller `fixed_wing_lqr`: the unconstrained optimum about the reference's steady flight, a
/// baseline for the tube-based MPC. u = K x on both axes.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec fixed_wing_lqr_spec();

/// @throws ConfigError if the vehicle has no wings or no trim, or the weights give no gain
std::unique_ptr<Controller> make_fixed_wing_lqr(const ParameterSet& parameters,
                                                const ControllerContext& context);

}  // namespace vinerow::controllers
