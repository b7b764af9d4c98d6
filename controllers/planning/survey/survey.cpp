#include "controllers/planning/survey/survey.h"

#include <fmt/format.h>

#include "controllers/parts/paths/verticals.h"
#include "controllers/planning/survey/survey_params.h"
#include "controllers/planning/survey/survey_plan.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

class Survey final : public Planner {
 public:
  Survey(SurveyRequest request, const PlannerContext& context)
      : request_(std::move(request)),
        scene_(context.scene),
        rest_height_m_(context.vehicle_description->height_above_ground_m),
        takes_off_(context.vehicle_description->rotorcraft.has_value()) {}

  Result<PlannedPath> plan(const Pose& start) override {
    report_ = {};
    auto plan = plan_survey(request_, start, make_ground(scene_, start.p.z() - rest_height_m_));
    if (!plan) return Failure{plan.reason()};
    report_.numbers = plan->numbers;
    PlannedPath path = plan->path;
    // `rotorcraft` of the request may differ: it sets how corners are flown.
    if (takes_off_) {
      add_take_off(start.p, path);
      if (request_.returns) add_landing(start.p.z(), path);
    }
    return path;
  }

  const PlanReport* report() const override { return &report_; }

 private:
  SurveyRequest request_;
  const SceneQuery* scene_;
  double rest_height_m_;
  bool takes_off_;
  PlanReport report_;
};

}  // namespace

PartSpec survey_spec() {
  PartSpec spec;
  spec.name = "survey";
  spec.description =
      "Parallel lanes over a parcel for a camera that looks down: height from ground sampling "
      "distance, overlaps, flyable turns, waypoints above the terrain (paper A, section 2; "
      "docs/guides/survey.md).";
  add_survey_parameters(spec);
  spec.reads = {"estimate"};
  spec.writes = {"plan"};
  return spec;
}

std::unique_ptr<Planner> make_survey(const ParameterSet& parameters,
                                     const PlannerContext& context) {
  const std::string who = context.part + " (survey)";
  if (!context.vehicle_description->flies()) {
    throw ConfigError(fmt::format("{} plans flights, but vehicle type '{}' does not fly", who,
                                  context.vehicle_description->type));
  }
  return std::make_unique<Survey>(read_survey_request(parameters, context, who), context);
}

}  // namespace vinerow::controllers
