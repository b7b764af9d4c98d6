#pragma once
/// Parameters of the estimator `distance_filter`.

#include <optional>

#include "controllers/estimation/row_localisation/distance_filter_law.h"
#include "engine/api/parameter_table_fwd.h"

namespace vinerow::controllers {

/// What the file says of the law and of what goes into it.
struct DistanceFilterOptions {
  DistanceFilterParams law;             ///< its `kalman` before the reading is taken into account
  std::optional<double> walk_m2_per_s;  ///< absent: the reading's
  double yaw_std_rad = 0.0;             ///< 0: as the inertial unit states
  double inertial_std_m = 1.0;          ///< of positions where the inertial unit states none
};

const ParameterTable<DistanceFilterOptions>& distance_filter_law_table();
/// The law's parameters with the process noise of the reading (kalman_params_of).
DistanceFilterParams make_distance_filter_params(const DistanceFilterOptions& options);

}  // namespace vinerow::controllers
