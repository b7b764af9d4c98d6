#pragma once
/// Planner `mission_file`: path of a ground station's mission (QGroundControl `.plan` or `QGC WPL
/// 110`).

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec mission_route_spec();

/// Reports "items", "waypoints", "length_m", "ignored_items" (that do not move the vehicle),
/// "loiters" (flown as waypoints), "height_above_ground_min_m" after the climb.
/// @throws ConfigError as io::read_mission() does; with the item's number, for items that cannot be
/// flown; for a mission without places, or far from the world's origin (with the origin that would
/// fit)
std::unique_ptr<Planner> make_mission_route(const ParameterSet& parameters,
                                            const PlannerContext& context);

}  // namespace vinerow::controllers
