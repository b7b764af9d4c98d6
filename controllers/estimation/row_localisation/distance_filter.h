#pragma once
/// Estimator `distance_filter`: where a vehicle is between mapped rows, after paper C (Donati et
/// al., Remote Sensing 14(6) 1374, 2022). The law is in distance_filter_law.h.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec distance_filter_spec();

/// @throws ConfigError if a range sensor that it is to use is not on the vehicle, or if there are
/// range sensors and the map has no row meshes (`use_map: false` does without both)
std::unique_ptr<Estimator> make_distance_filter(const ParameterSet& parameters,
                                                const EstimatorContext& context);

}  // namespace vinerow::controllers
