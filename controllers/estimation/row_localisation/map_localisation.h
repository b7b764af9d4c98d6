#pragma once
/// Estimator `map_localisation`: map_localisation_law.h behind signals.
///
/// Reads `ins` (Odometry of an aided inertial unit: its velocity and attitude, never its position),
/// `gps` (GnssFix) and range sensors; writes "estimate" with its full covariance, "estimator_state"
/// and "estimator_event". Starts at the first tick, about the truth with a draw of `start_std_m`:
/// as a vehicle does that was put down at a place known as well as that.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::controllers {

PartSpec map_localisation_spec();
/// @throws ConfigError where the map has no row meshes, or a range sensor is not the vehicle's
std::unique_ptr<Estimator> make_map_localisation(const ParameterSet& parameters,
                                                 const EstimatorContext& context);

}  // namespace vinerow::controllers
