#pragma once
/// Parameters of the estimator `distance_filter`.

#include <vector>

#include "controllers/estimation/distance_filter_law.h"
#include "engine/api/parameters.h"

namespace vinerow {

std::vector<ParameterSpec> distance_filter_parameters();
DistanceFilterParams read_distance_filter_params(const ParameterSet& parameters);

}  // namespace vinerow
