#pragma once
/// What the planned pictures will show of the polygon, over its real terrain.

#include <optional>
#include <vector>

#include "controllers/planning/survey/survey_plan.h"

namespace vinerow::controllers {

struct SurveyForecast {
  double covered_share = 0.0;  ///< of the polygon's area, seen on a picture at least
  int least_views = 0;         ///< pictures of the place that is seen least
  double mean_views = 0.0;
};

/// Looks at about 20,000 places of the polygon. The camera looks straight down; what hides behind
/// hills is not asked.
/// @param[out] bare_W  a place of the polygon without ground, where there is one
SurveyForecast forecast_survey(const SurveyRequest& request, const std::vector<SurveyShot>& shots,
                               const GroundHeight& ground, std::optional<Eigen::Vector2d>& bare_W);

}  // namespace vinerow::controllers
