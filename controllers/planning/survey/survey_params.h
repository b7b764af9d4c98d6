#pragma once
/// The parameters of surveys, read against the vehicle that is to fly them.

#include <string>
#include <vector>

#include "controllers/planning/survey/survey_heights.h"
#include "controllers/planning/survey/survey_request.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

std::vector<ParameterSpec> survey_parameters();

/// The vehicle's `stall_speed_mps`, `min_turning_radius_m` and `max_bank_rad` count where it tells
/// them. Without `rotorcraft` it is planned for as what it is. The polygon is the one given, or the
/// parcel of the map.
/// @throws ConfigError beginning with `who`: no polygon, two of them, gsd_m beside height_m, a bank
/// that the vehicle does not fly, and all that find_survey_fault() finds
SurveyRequest read_survey_request(const ParameterSet& parameters, const PlannerContext& context,
                                  const std::string& who);

/// The terrain of a scene; flat at `flat_m` where there is no scene.
GroundHeight make_ground(const SceneQuery* scene, double flat_m);

}  // namespace vinerow::controllers
