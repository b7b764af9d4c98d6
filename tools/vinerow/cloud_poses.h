#pragma once
/// Camera and camera poses of the pictures behind a point cloud.

#include <filesystem>
#include <string>

#include "controllers/planning/survey/survey_plan.h"
#include "engine/api/product.h"
#include "engine/api/registry.h"
#include "engine/scenario/scenario.h"

namespace vinerow::tools {

/// Pictures as flown: true poses at the shots of one camera_trigger.
/// @param vehicle,sensor  names, or "" if only one took pictures
/// @throws ConfigError: no pictures, several cameras without a choice, unknown names
PictureSet pictures_of_log(const std::filesystem::path& log, const Registry& registry,
                           const std::string& vehicle, const std::string& sensor);

/// Pictures as planned: camera straight down, heading along the lane.
/// @param file  scenario, for people
PictureSet pictures_of_plan(const controllers::SurveyPlan& plan, const SurveyCamera& camera,
                            const std::filesystem::path& file);

/// The same for the plan of a vehicle's planner `survey`.
/// @param vehicle  name, or "" for the first that surveys
/// @throws ConfigError: no vehicle surveys, the survey cannot be planned
PictureSet pictures_of_plan(const scenario::Scenario& scenario, const std::filesystem::path& file,
                            const Registry& registry, const std::string& vehicle);

}  // namespace vinerow::tools
