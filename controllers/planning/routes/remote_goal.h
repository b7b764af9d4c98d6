#pragma once
/// Guidance that drives to goals from outside the run: a click in a viewer, a ROS 2 node.

#include <memory>

#include "engine/api/registry.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec remote_goal_spec();
/// Reads "goal_pose" from outside and "estimate"; writes "plan" for a path follower.
/// @throws ConfigError for a vehicle without wheels, and as PlaceRoute
std::unique_ptr<Guidance> make_remote_goal(const ParameterSet& parameters,
                                           const ControllerContext& context);

}  // namespace vinerow::controllers
