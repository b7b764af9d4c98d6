#pragma once
/// Top view of a planned survey, as in figure 6 of paper A.

#include <string>

#include "controllers/planning/survey/survey_plan.h"
#include "controllers/planning/survey/survey_request.h"
#include "engine/render/scene.h"

namespace vinerow::tools {

/// North is up. Shows shaded terrain with contour lines, the area, lanes coloured in flight order,
/// numbered waypoints, turns and transits as thin lines, and the footprint of one picture.
/// @param title  first line below the map
render::Image draw_survey(const controllers::SurveyRequest& request,
                          const controllers::SurveyPlan& plan,
                          const controllers::GroundHeight& ground, const std::string& title);

}  // namespace vinerow::tools
