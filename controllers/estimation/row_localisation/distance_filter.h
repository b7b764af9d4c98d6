#pragma once
/// Estimator `distance_filter`: position of a vehicle between mapped rows, after paper C (Donati et
/// al., Remote Sensing 14(6) 1374, 2022). The law is in distance_filter_law.h.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec distance_filter_spec();

/// @throws ConfigError if the vehicle lacks a range sensor that is named, or if there are range
/// sensors and the map has no row meshes (`use_map: false` needs neither)
std::unique_ptr<Estimator> make_distance_filter(const ParameterSet& parameters,
                                                const EstimatorContext& context);

}  // namespace vinerow::controllers
