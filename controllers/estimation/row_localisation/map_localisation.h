#pragma once
/// Estimator `map_localisation`: map_localisation_law.h behind signals.
///
/// Reads `ins` (Odometry of an aided inertial unit: its velocity and attitude, never its position),
/// `gps` (GnssFix) and range sensors; writes "estimate" with its full covariance, "estimator_state"
/// and "estimator_event". It starts at the first tick from the true position plus an error drawn
/// with `start_std_m`, like a vehicle that was placed at a position known to that accuracy.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::controllers {

PartSpec map_localisation_spec();
/// @throws ConfigError if the map has no row meshes, or the vehicle lacks a range sensor that is
/// named
std::unique_ptr<Estimator> make_map_localisation(const ParameterSet& parameters,
                                                 const EstimatorContext& context);

}  // namespace vinerow::controllers
