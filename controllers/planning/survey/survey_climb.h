#pragma once
/// From the start to the first lane's height.

#include <optional>
#include <vector>

#include "controllers/planning/survey/survey_heights.h"
#include "controllers/planning/survey/survey_request.h"
#include "controllers/planning/survey/survey_route.h"

namespace vinerow::controllers {

struct SurveyClimb {
  SurveyRoute route;  ///< with laps beside the start where the way to the first lane is too short
  GroundProfile profile;         ///< below the route
  std::vector<double> wanted_m;  ///< heights at the profile's samples
  double length_m = 0.0;         ///< of the way until the wanted height is reached
  double clearance_m = 0.0;      ///< least height above the ground until then
  double where_m = 0.0;          ///< along the way, of that
  Eigen::Vector2d meets_W = {0, 0};
};

/// Climbs, or sinks, at max_slope. Laps begin straight ahead of the start and turn to the side that
/// keeps more height above the ground.
/// @returns "the climb ... meets the ground at ..."
Result<SurveyClimb> climb_to_first_lane(const SurveyRequest& request, const Pose& start_W,
                                        const SurveyRoute& route, const GroundHeight& ground);

/// @returns "point 3 of the polygon at (x, y) lies outside the terrain, which begins 12.3 m ..."
std::optional<std::string> find_corner_outside(const Polygon2& polygon, const GroundHeight& ground);

}  // namespace vinerow::controllers
