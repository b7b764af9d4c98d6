#pragma once
/// Plan of an aerial survey: from polygon, camera and terrain to waypoints, pictures and their
/// coverage (paper A, section 2).

#include <map>
#include <string>
#include <vector>

#include "controllers/planning/survey/survey_heights.h"
#include "controllers/planning/survey/survey_lanes.h"
#include "controllers/planning/survey/survey_request.h"
#include "engine/api/messages/path.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

/// A planned picture.
struct SurveyShot {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;   ///< of the picture's forward axis: the direction of flight
  double height_m = 0.0;  ///< above the ground below
  int lane = 0;
};

struct SurveyPlan {
  PlannedPath path;  ///< kinds as in PathKind; `alley` is the lane's index from one side
  LaneFrame frame;
  std::vector<SurveyLane> lanes;
  std::vector<int> order;  ///< indices of lanes, as flown
  std::vector<SurveyShot> shots;
  double photo_distance_m = 0.0;
  bool rotorcraft = false;  ///< as requested
  /// Figures of the plan, names with units; the same as PlanReport::numbers.
  std::map<std::string, double> numbers;
};

/// Plans from a start pose and back there.
///
/// On each lane the camera works from kLeg points on. Lanes continue for `run_out_m` and are joined
/// by turns of two corners of 90 degrees, or of four if two turning radii do not fit between them.
/// Waypoints are at the wanted height above the terrain. Ramps between them miss it by at most
/// `ramp_error_m`, upwards by more if the terrain is steeper than `max_slope`. From the start the
/// path climbs at max_slope, in laps near the start if the path to the first lane is too short. A
/// rotorcraft starts above the start place, at the wanted height, and stops at corners.
///
/// @param start_W  start place and heading of the aircraft
/// @returns the plan, or the reason of the failure: see find_survey_fault(); a corner outside the
/// terrain, with the distance; a climb into the ground
Result<SurveyPlan> plan_survey(const SurveyRequest& request, const Pose& start_W,
                               const GroundHeight& ground);

}  // namespace vinerow::controllers
