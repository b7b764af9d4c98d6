#pragma once
/// Planner `waypoints`: a path from a list of points in the scenario or in a CSV file.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec waypoints_spec();

/// @throws ConfigError if the lists differ in length, fewer than two points are given, or a line of
/// the file is not two numbers
std::unique_ptr<Planner> make_waypoints(const ParameterSet& parameters,
                                        const PlannerContext& context);

}  // namespace vinerow::controllers
