#pragma once
/// How a vehicle flies: height, speed, tilt, what its rotors had left, and whether it crashed.
///
/// Vehicles that do not fly (VehicleDescription::flies) have no such results at all. Judged at the
/// metric's rate, by the truth; after a crash nothing more is added. Vehicles with wings do not
/// hover, have no rotors and glide home: of them only the first two lines, the mean speed, the tilt
/// and `crashed` are told (air_tracking tells the rest). Results:
///   altitude_error_rms_m, altitude_error_max_m: on the legs, true height less the plan's at the
///     nearest place; not measured where the plan is one for the ground
///   height_above_ground_min_m, height_above_ground_max_m: on the legs, of B's origin above the
///     true ground
///   row_speed_mean_mps: mean true speed on the legs
///   row_speed_error_max_mps: on the legs, largest difference of the true speed and the
///   reference's,
///     where that is constant (tangential acceleration at most 0.1 m/s2)
///   return_clearance_min_m: on the way home (PathKind::kReturn, without the steep climb that
///     begins it), least height of B's origin above what lies below it: ground, canopy, posts
///   tilt_max_deg: largest angle of the body's z axis from the vertical
///   thrust_limit_share: share of the ticks in the air at which a rotor's command sat at one of its
///     limits
///   crashed: 1 or 0.

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/metrics/metric_numbers.h"

namespace vinerow::metrics {

const std::vector<MetricNumber>& flight_numbers();
PartSpec flight_spec();
std::unique_ptr<Metric> make_flight(const ParameterSet& parameters, const MetricContext& context);

}  // namespace vinerow::metrics
