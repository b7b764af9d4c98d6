#pragma once
/// Leg in an alley with detours around obstacles, if the alley is wide enough.

#include <string>

#include "controllers/planning/routes/route_clearance.h"
#include "controllers/planning/search/pose_search.h"

namespace vinerow::controllers {

struct LegDetourParams {
  double radius_m = 1.0;  ///< minimum of the vehicle
  double step_m = 0.1;    ///< between poses that are checked
  double speed_mps = 0.0;
};

/// Straights along the free parts of the leg. Around each blocked stretch, from some turning radii
/// before it to as many behind it, the result of the search. A free leg consists of its straights
/// alone.
/// @param problem  of the first search, see PoseSearch; each takes the next @param reports  added
/// to
/// @returns the pieces, or the reason why a stretch cannot be passed
Result<PathSegments> drive_around(const RouteLeg& leg, const Footprint& footprint,
                                  const RouteClearance& clearance, PoseSearch& search, int problem,
                                  const LegDetourParams& params,
                                  std::vector<SearchReport>& reports);

}  // namespace vinerow::controllers
