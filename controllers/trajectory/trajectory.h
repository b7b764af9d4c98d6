#pragma once
/// Guidance `trajectory`: converts a plan in space to a reference in time for rotorcraft (paper A,
/// section 4.2): position, velocity and acceleration, now and over the controller's horizon. Parts:
/// flight_curve.h, smooth_run.h, time_law.h, flight_trajectory.h.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec trajectory_spec();

/// @throws ConfigError as read_trajectory_params does
std::unique_ptr<Guidance> make_trajectory(const ParameterSet& parameters,
                                          const ControllerContext& context);

}  // namespace vinerow::controllers
