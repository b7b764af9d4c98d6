#pragma once
/// Controller `mpc_nominal`: ordinary linear model predictive control of fixed-wing vehicles, with
/// the model, weights, horizon and limits of `trmpc` but without gusts: limits are not tightened
/// and the prediction starts at the state.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec mpc_nominal_spec();

/// @throws ConfigError if the vehicle has no wings or no trim
std::unique_ptr<Controller> make_mpc_nominal(const ParameterSet& parameters,
                                             const ControllerContext& context);

}  // namespace vinerow::controllers
