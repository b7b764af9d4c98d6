#pragma once
/// Climb of a survey from the start to the height of the first lane.

#include <optional>
#include <vector>

#include "controllers/planning/survey/survey_heights.h"
#include "controllers/planning/survey/survey_request.h"
#include "controllers/planning/survey/survey_route.h"

namespace vinerow::controllers {

struct SurveyClimb {
  SurveyRoute route;      ///< with laps near the start if the path to the first lane is too short
  GroundProfile profile;  ///< below the route
  std::vector<double> wanted_m;  ///< heights at the profile's samples
  double length_m = 0.0;         ///< distance along the path until the wanted height is reached
  double clearance_m = 0.0;      ///< minimum height above the ground until then
  double where_m = 0.0;          ///< distance along the path of that minimum
  Eigen::Vector2d meets_W = {0, 0};
};

/// Climbs or descends at max_slope. Laps start straight ahead of the start and turn to the side
/// with more height above the ground. @returns the climb, or "the climb ... meets the ground at
/// ..."
Result<SurveyClimb> climb_to_first_lane(const SurveyRequest& request, const Pose& start_W,
                                        const SurveyRoute& route, const GroundHeight& ground);

/// Finds a corner of the polygon that has no terrain below. @returns "point 3 of the polygon at (x,
/// y) is outside the terrain, which starts 12.3 m ..."
std::optional<std::string> find_corner_outside(const Polygon& polygon, const GroundHeight& ground);

}  // namespace vinerow::controllers
