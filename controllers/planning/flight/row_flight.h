#pragma once
/// Planner `row_flight`: mission of a flying vehicle over the row map. It climbs vertically, flies
/// along the alleys at a height above the terrain with the ground planners' turns, returns home
/// above terrain and canopy, and descends vertically (paper A, section 4.2 and figure 20).

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec row_flight_spec();

/// Reports, in addition to the numbers of the turns' planner ("turns", "turn_length_m"; on a grid
/// also "nodes", "iterations", "clearance_m", "turn_clearance_m"): "length_m" of the whole flight,
/// "climb_m", the sum of all ascents, "return_length_m", "return_clearance_m", the minimum height
/// of the path home above ground and canopies, and "row_height_error_m", the largest deviation of
/// the smoothed heights from height_m above the ground.
/// @throws ConfigError as read_route_planner_params does, for a map without a grid if turns is
/// grid, and for a height_m that is not above the height of the vehicle on the ground
std::unique_ptr<Planner> make_row_flight(const ParameterSet& parameters,
                                         const PlannerContext& context);

}  // namespace vinerow::controllers
