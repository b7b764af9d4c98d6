#pragma once
/// Flight quality: height, speed, hover, tilt, rotor saturation and crash.
///
/// Vehicles that do not fly (VehicleDescription::flies) have no such results. The metric samples
/// the truth at its rate, until a crash. Fixed-wing vehicles have only the altitude errors, the
/// heights above ground, the mean speed, the tilt and `crashed`; air_tracking has their other
/// results. Results:
///   altitude_error_rms_m, altitude_error_max_m: on the legs, true height minus the plan's at the
///     nearest point; not measured if the plan is one for the ground
///   height_above_ground_min_m, height_above_ground_max_m: on the legs, of B's origin above the
///     true ground
///   row_speed_mean_mps: mean true speed on the legs
///   row_speed_error_max_mps: on the legs, largest difference of the true speed from the
///     reference's, while that is constant (tangential acceleration at most 0.1 m/s2)
///   return_clearance_min_m: on the return (PathKind::kReturn, without its initial steep climb),
///     smallest height of B's origin above the ground, canopy or posts below it
///   hover_error_rms_m, hover_error_max_m: distance from the reference while it hovers
///   tilt_max_deg: in the air, largest angle of the body's z axis from the vertical
///   thrust_limit_share: share of the ticks in the air at which a rotor's command is at one of its
///     limits
///   crashed: 1 or 0.

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/result_spec.h"

namespace vinerow::metrics {

const std::vector<ResultSpec>& flight_results();
PartSpec flight_spec();
std::unique_ptr<Metric> make_flight(const ParameterSet& parameters, const MetricContext& context);

}  // namespace vinerow::metrics
