#pragma once
/// Planner `mission_file`: flies a mission of a ground station (QGroundControl `.plan` or `QGC WPL
/// 110`).

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec mission_route_spec();

/// Reports "items", "waypoints", "length_m", "ignored_items" (they do not move the vehicle),
/// "loiters" (flown as waypoints), "height_above_ground_min_m" after the climb.
/// @throws ConfigError as io::read_mission() does, and with the item's number: what cannot be
/// flown, nothing to fly, a mission far from the world's origin (with the origin that would fit)
std::unique_ptr<Planner> make_mission_route(const ParameterSet& parameters,
                                            const PlannerContext& context);

}  // namespace vinerow::controllers
