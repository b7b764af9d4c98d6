#pragma once
/// Estimator `row_camera`: place and heading between mapped rows from a camera, wheels and a rate
/// gyro, without satellites (row_marks.h, row_camera_filter.h).

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec row_camera_spec();

/// @throws ConfigError if the vehicle has no sensor of this name or no wheels, or the map no rows
std::unique_ptr<Estimator> make_row_camera(const ParameterSet& parameters,
                                           const EstimatorContext& context);

}  // namespace vinerow::controllers
