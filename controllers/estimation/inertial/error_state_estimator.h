#pragma once
/// Estimator `error_state_kalman`: inertial navigation aided by satellite fixes, the baseline of
/// localisation. The law is in error_state_kalman.h.
///
/// Reads "<imu>", "<gnss>" and, if named, "<barometer>", "<magnetometer>", "<wheels>", "<heading>";
/// "truth" at the first tick only, to draw the start about it. The mountings of the sensors come
/// from the vehicle's description. Run it at the IMU's rate: a slower estimator misses readings.
/// Writes "estimate" and "estimator_state", whose names are:
///   nis_<s>, used_<s>, rejected_<s> of the sources gnss_position (3 numbers, so a mean NIS of 3),
///     gnss_velocity (3), barometer (1), magnetometer (1), wheels (3), heading (3: the baseline
///     between two antennas), zero_velocity (3): NIS of the last reading used (0 before), and
///     counts; readings that are too old, repeated or not finite are rejected too;
///   imu_refused, imu_gaps, covariance_repairs, restarts.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec error_state_kalman_spec();

/// @throws ConfigError if wheels are named and the vehicle has no wheels, or if zero_velocity is
/// wheels and no wheels are named
std::unique_ptr<Estimator> make_error_state_kalman(const ParameterSet& parameters,
                                                   const EstimatorContext& context);

}  // namespace vinerow::controllers
