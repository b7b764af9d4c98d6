#pragma once
/// A survey from the air: from polygon, camera and terrain to waypoints, pictures and what they
/// will show (paper A, section 2).

#include <map>
#include <string>
#include <vector>

#include "controllers/planning/survey/survey_heights.h"
#include "controllers/planning/survey/survey_lanes.h"
#include "controllers/planning/survey/survey_request.h"
#include "engine/api/messages/path.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

/// A picture as it is planned.
struct SurveyShot {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;   ///< of the picture's long way: the direction of flight
  double height_m = 0.0;  ///< above the ground below
  int lane = 0;
};

struct SurveyPlan {
  PlannedPath path;  ///< kinds as PathKind says; `alley` is the lane's index from one side
  LaneFrame frame;
  std::vector<SurveyLane> lanes;
  std::vector<int> order;  ///< indices of lanes, as flown
  std::vector<SurveyShot> shots;
  double photo_distance_m = 0.0;
  bool rotorcraft = false;  ///< as it was asked for
  /// What it amounts to, names with units; also what PlanReport::numbers shows.
  std::map<std::string, double> numbers;
};

/// Plans from a start pose and back there.
///
/// On each lane the camera works from kLeg points on; lanes go on for `run_out_m` and are joined by
/// turns of two corners of 90 degrees, or four where two turning radii do not fit between them.
/// Waypoints lie at the wanted height above the terrain; ramps between them miss it by at most
/// `ramp_error_m`, upwards more where the terrain is steeper than `max_slope`. From the start the
/// way climbs at max_slope, in laps beside the start where the way to the first lane is too short.
/// A rotorcraft begins above the start, at the wanted height, and stops at corners.
///
/// @param start_W  where the aircraft starts, and its heading
/// @returns why not: see find_survey_fault(); a corner outside the terrain, with how far; a climb
/// into the ground
Result<SurveyPlan> plan_survey(const SurveyRequest& request, const Pose& start_W,
                               const GroundHeight& ground);

}  // namespace vinerow::controllers
