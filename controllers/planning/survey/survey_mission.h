#pragma once
/// Conversion of a survey to a mission for ground stations and autopilots.

#include "controllers/planning/survey/survey_plan.h"
#include "engine/io/missions/mission_file.h"

namespace vinerow::controllers {

/// Items: take-off (22) to the first waypoint, speed (178), waypoints (16), camera trigger by
/// distance (206) on and off at the lanes' ends, then return (20) if the survey returns. A
/// rotorcraft takes off vertically to the first height, and its speed is over ground. Altitudes are
/// above home, the ground below the start.
/// @param home_ground_m  z in W of the ground at home
io::MissionFile make_survey_mission(const SurveyPlan& plan, const GeoOrigin& origin,
                                    double home_ground_m, bool returns);

}  // namespace vinerow::controllers
