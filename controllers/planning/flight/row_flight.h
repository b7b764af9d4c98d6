#pragma once
/// Planner `row_flight`: a whole mission of a flying vehicle over the row map: straight up, along
/// the alleys at a height above the terrain with the ground planners' turns, home above terrain and
/// canopy, straight down (paper A, section 4.2 and figure 20).

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec row_flight_spec();

/// Reports beside what the turns' planner tells (row_flight reports "turns", "turn_length_m"; on a
/// grid also "nodes", "iterations", "clearance_m", "turn_clearance_m"): "length_m" of the whole
/// flight, "climb_m", all that goes up, "return_length_m", "return_clearance_m", least height of
/// the way home above ground and canopies, and "row_height_error_m", how much the smoothed heights
/// differ from height_m above the ground at most.
/// @throws ConfigError as read_route_planner_params does, for a map without a grid where
/// turns: grid, and for a height_m that is not above the vehicle's height when it stands
std::unique_ptr<Planner> make_row_flight(const ParameterSet& parameters,
                                         const PlannerContext& context);

}  // namespace vinerow::controllers
