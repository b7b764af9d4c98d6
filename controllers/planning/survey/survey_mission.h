#pragma once
/// A survey as a mission for ground stations and autopilots.

#include "controllers/planning/survey/survey_plan.h"
#include "engine/io/missions/mission_file.h"

namespace vinerow::controllers {

/// Take-off (22) to the first waypoint, speed (178), waypoints (16), camera trigger by distance
/// (206) on and off at the lanes' ends, then return (20) where the survey does. A rotorcraft takes
/// off straight up to the first height, and its speed is over ground.
/// Altitudes are above home: the ground below the start.
/// @param home_ground_m  z of W there
io::MissionFile make_survey_mission(const SurveyPlan& plan, const GeoOrigin& origin,
                                    double home_ground_m, bool returns);

}  // namespace vinerow::controllers
