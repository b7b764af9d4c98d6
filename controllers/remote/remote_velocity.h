#pragma once
/// Controller that drives by speed and yaw rate from outside the run: a joystick, a ROS 2 node.

#include <memory>

#include "engine/api/registry.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec remote_velocity_spec();
/// Reads "cmd_vel" from outside; writes "actuators" and "command".
/// @throws ConfigError as make_twist_drive()
std::unique_ptr<Controller> make_remote_velocity(const ParameterSet& parameters,
                                                 const ControllerContext& context);

}  // namespace vinerow::controllers
