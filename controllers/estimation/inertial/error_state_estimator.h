#pragma once
/// Estimator `error_state_kalman`: inertial navigation held by satellite fixes, the baseline of
/// localisation. The law: error_state_kalman.h.
///
/// Reads "<imu>", "<gnss>" and, where named, "<barometer>", "<magnetometer>", "<wheels>",
/// "<heading>"; "truth" at the first tick only, to draw the start about it. Where the sensors sit
/// it takes from their data sheets. Give it the IMU's rate: a slower one sees only some of the
/// readings. Writes "estimate" and "estimator_state", whose names are:
///   nis_<s>, used_<s>, rejected_<s> of the sources gnss_position (3 numbers, so a mean NIS of 3),
///     gnss_velocity (3), barometer (1), magnetometer (1), wheels (3), heading (3: the
///     way between two antennas), zero_velocity (3): NIS of
///     the last one used (0 before), and counts; too old, doubled or not finite is rejected too;
///   imu_refused, imu_gaps, covariance_repairs, restarts.

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec error_state_kalman_spec();

/// @throws ConfigError if wheels are named and the vehicle has none, or zero_velocity: wheels is
/// asked for without
std::unique_ptr<Estimator> make_error_state_kalman(const ParameterSet& parameters,
                                                   const EstimatorContext& context);

}  // namespace vinerow::controllers
