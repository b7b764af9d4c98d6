#pragma once
/// Planning task of `vinerow survey`, from a scenario or from a polygon.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "controllers/planning/survey/survey_heights.h"
#include "controllers/planning/survey/survey_request.h"
#include "engine/sim/simulation.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {

/// Command-line arguments of `vinerow survey`.
struct SurveyArguments {
  ScenarioArguments scenario;
  std::string vehicle;
  std::filesystem::path polygon, dem, out, log;
  bool pictures = false;
  std::optional<int> picture_width;
  std::vector<std::string> bands;
  std::string sensor;
  std::string crs;
  std::vector<double> origin, start;
  std::optional<double> heading_deg;
  std::map<std::string, std::string> values;  ///< parameters of the planner, as texts
};

/// All data that planning a survey needs.
struct SurveyTask {
  std::string title;
  controllers::SurveyRequest request;
  controllers::GroundHeight ground;
  GeoOrigin origin;
  Pose start_W;
};

/// Task for the area in `polygon`, above flat ground or an elevation model. @throws ConfigError
SurveyTask task_of_polygon(const SurveyArguments& arguments);

/// Task of a vehicle whose planner is `survey`.
/// @param simulation  must outlive the task, which uses its ground
/// @throws ConfigError
SurveyTask task_of_scenario(const SurveyArguments& arguments, const scenario::Scenario& scenario,
                            Simulation& simulation);

}  // namespace vinerow::tools
