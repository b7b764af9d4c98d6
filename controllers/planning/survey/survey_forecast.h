#pragma once
/// Forecast of how the planned pictures cover the polygon, over its terrain.

#include <optional>
#include <vector>

#include "controllers/planning/survey/survey_plan.h"

namespace vinerow::controllers {

struct SurveyForecast {
  double covered_share = 0.0;  ///< of the polygon's area, seen on at least one picture
  int min_views = 0;           ///< minimum number of pictures that show a place
  double mean_views = 0.0;
};

/// Evaluates about 20,000 places of the polygon. The camera looks straight down; occlusion by hills
/// is ignored. @param[out] bare_W a place of the polygon without ground, if there is one
SurveyForecast forecast_survey(const SurveyRequest& request, const std::vector<SurveyShot>& shots,
                               const GroundHeight& ground, std::optional<Eigen::Vector2d>& bare_W);

}  // namespace vinerow::controllers
