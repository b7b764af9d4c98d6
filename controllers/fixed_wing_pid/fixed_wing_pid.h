#pragma once
/// Controller `fixed_wing_pid`: the usual autopilot of cascaded loops. See fixed_wing_pid_law.h.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec fixed_wing_pid_spec();

/// @throws ConfigError if the vehicle has no wings or no trim
std::unique_ptr<Controller> make_fixed_wing_pid(const ParameterSet& parameters,
                                                const ControllerContext& context);

}  // namespace vinerow::controllers
