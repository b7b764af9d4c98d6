#pragma once
/// Controller that passes on actuator commands from outside the run: an autopilot, a ROS 2 node.

#include <memory>

#include "engine/api/registry.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec remote_actuators_spec();
/// Reads "actuator_command" from outside; writes "actuators".
std::unique_ptr<Controller> make_remote_actuators(const ParameterSet& parameters,
                                                  const ControllerContext& context);

}  // namespace vinerow::controllers
