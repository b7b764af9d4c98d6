#pragma once
/// Planner `survey`: lanes over a parcel for aerial pictures (paper A, section 2).

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec survey_spec();

/// The report's numbers are SurveyPlan::numbers. @throws ConfigError as read_survey_request(), and
/// if the vehicle does not fly
std::unique_ptr<Planner> make_survey(const ParameterSet& parameters, const PlannerContext& context);

}  // namespace vinerow::controllers
