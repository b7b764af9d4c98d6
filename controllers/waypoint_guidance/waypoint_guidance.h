#pragma once
/// Guidance `waypoint_guidance`: converts a plan of waypoints to the reference of a fixed-wing
/// vehicle (paper A, eq. 1-7, in the form of the reference of paper A, section 2), from the
/// launcher to the ground.

#include <memory>

#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec waypoint_guidance_spec();
std::unique_ptr<Guidance> make_waypoint_guidance(const ParameterSet& parameters,
                                                 const ControllerContext& context);

}  // namespace vinerow::controllers
