#pragma once
/// Selection of the range sensors that an estimator uses, and the check of its map.

#include <string>
#include <vector>

#include "controllers/estimation/row_localisation/range_prediction.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// Name and mounting of the named sensors, or of all ultrasonic sensors if no name is given.
/// @param who  for errors: "rover.estimator (distance_filter)"  @param key  the parameter that
/// names
/// @throws ConfigError with the names of the vehicle's sensors if a name is not among them
std::vector<RangeSensorModel> find_range_sensors(const std::vector<std::string>& names,
                                                 const EstimatorContext& context,
                                                 const std::string& who,
                                                 const std::string& key = "ranges");

/// @param advice  alternative for the user, such as "set use_map: false", or ""
/// @throws ConfigError if the vehicle's map has no row meshes
void demand_row_meshes(const EstimatorContext& context, const std::string& who,
                       const std::string& advice);

}  // namespace vinerow::controllers
