#pragma once
/// Which of a vehicle's range sensors an estimator uses, and the map they are compared with.

#include <string>
#include <vector>

#include "controllers/estimation/row_localisation/range_prediction.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// Those named, or all ultrasounds where no name is given: name and mounting.
/// @param who  for errors: "rover.estimator (distance_filter)"  @param key  the parameter that
/// names
/// @throws ConfigError naming the sensors there are
std::vector<RangeSensorModel> find_range_sensors(const std::vector<std::string>& names,
                                                 const EstimatorContext& context,
                                                 const std::string& who,
                                                 const std::string& key = "ranges");

/// @param advice  what else the user may do, "say use_map: false", or ""
/// @throws ConfigError where the vehicle's map has no row meshes
void demand_row_meshes(const EstimatorContext& context, const std::string& who,
                       const std::string& advice);

}  // namespace vinerow::controllers
