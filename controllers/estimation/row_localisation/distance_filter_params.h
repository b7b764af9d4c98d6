#pragma once
/// Parameters of the estimator `distance_filter`.

#include <optional>

#include "controllers/estimation/row_localisation/distance_filter_law.h"
#include "engine/api/parameter_table_fwd.h"

namespace vinerow::controllers {

/// Options of the law and its inputs, as read from the scenario.
struct DistanceFilterOptions {
  DistanceFilterParams law;             ///< its `kalman` without the defaults of `reading`
  std::optional<double> walk_m2_per_s;  ///< absent: the value of `reading`
  double yaw_std_rad = 0.0;             ///< 0: as the inertial unit states
  double inertial_std_m = 1.0;          ///< of inertial positions without a stated deviation
};

const ParameterTable<DistanceFilterOptions>& distance_filter_law_table();
/// Parameters of the law, with the process noise of the interpretation (kalman_params_of).
DistanceFilterParams make_distance_filter_params(const DistanceFilterOptions& options);

}  // namespace vinerow::controllers
