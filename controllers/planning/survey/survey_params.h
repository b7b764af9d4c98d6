#pragma once
/// Parameters of surveys, checked against the vehicle that flies them.

#include <string>
#include <vector>

#include "controllers/planning/survey/survey_heights.h"
#include "controllers/planning/survey/survey_request.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

void add_survey_parameters(PartSpec& spec);

/// Respects the vehicle's `stall_speed_mps`, `min_turning_radius_m` and `max_bank_rad` if it has
/// them. Without the key `rotorcraft`, the kind of vehicle decides. The polygon is the given one,
/// or the parcel of the map.
/// @throws ConfigError that starts with `who` if there is no polygon or there are two, if gsd_m and
/// height_m are both given, if the bank exceeds the vehicle's, and for faults of
/// find_survey_fault()
SurveyRequest read_survey_request(const ParameterSet& parameters, const PlannerContext& context,
                                  const std::string& who);

/// Ground of a scene's terrain; flat at `flat_m` if there is no scene.
GroundHeight make_ground(const SceneQuery* scene, double flat_m);

}  // namespace vinerow::controllers
