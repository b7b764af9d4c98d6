#pragma once
/// Controller `trmpc`: tube-based robust model predictive control of fixed-wing vehicles, paper A,
/// section 2.2, eq. 8-20 in a corrected form (docs/papers/trmpc.md).

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec trmpc_spec();

/// @throws ConfigError if the vehicle has no wings or no trim, a gain does not stabilise, or gusts
/// are too strong for the limits
std::unique_ptr<Controller> make_trmpc(const ParameterSet& parameters,
                                       const ControllerContext& context);

}  // namespace vinerow::controllers
