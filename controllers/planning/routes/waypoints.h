#pragma once
/// Planner `waypoints`: a path given point by point, in the scenario or in a CSV file.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec waypoints_spec();

/// @throws ConfigError if the lists differ in length, fewer than two points are given, or the file
/// has a
///         line that is not two numbers
std::unique_ptr<Planner> make_waypoints(const ParameterSet& parameters,
                                        const PlannerContext& context);

}  // namespace vinerow::controllers
