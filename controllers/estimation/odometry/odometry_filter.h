#pragma once
/// Estimator `odometry_filter`: dead reckoning, corrected by satellite fixes.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec odometry_filter_spec();

/// @throws ConfigError if odometry_source is wheels and the vehicle has no left and right wheels
std::unique_ptr<Estimator> make_odometry_filter(const ParameterSet& parameters,
                                                const EstimatorContext& context);

}  // namespace vinerow::controllers
