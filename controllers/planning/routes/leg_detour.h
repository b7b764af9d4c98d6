#pragma once
/// A leg in an alley with something in the way, driven around it where the alley is wide enough.

#include <string>

#include "controllers/planning/routes/route_room.h"
#include "controllers/planning/search/pose_search.h"

namespace vinerow::controllers {

struct LegDetourParams {
  double radius_m = 1.0;  ///< least of the vehicle
  double step_m = 0.1;    ///< between poses that are looked at
  double speed_mps = 0.0;
};

/// Straights along the leg where it is free; from some turning radii before each blocked stretch to
/// as many behind it what the search finds. A free leg is its straights and nothing else.
/// @param problem  of the first search, see PoseSearch; each takes the next @param reports  added
/// to
/// @returns the pieces, or why the stretch cannot be passed
Result<PathPieces> drive_around(const RouteLeg& leg, const Footprint& footprint,
                                const RouteRoom& room, PoseSearch& search, int problem,
                                const LegDetourParams& params, std::vector<SearchReport>& reports);

}  // namespace vinerow::controllers
