#pragma once
/// How much the wheels slip along their rolling direction, on the whole way and in the turns.
///
/// Reads "wheels", the diagnostics of a wheeled vehicle: wheel_<n>_slip = (R omega - v_x) /
/// max(|R omega|, |v_x|) and wheel_<n>_slip_angle_rad (vehicles/parts/wheel.h). Every sample of it
/// counts once, so their rate is the scenario's record.truth_rate_Hz. In turns means: the vehicle
/// is nearest to a turn of its plan (PlanStretch).
///
/// Left out are samples that mean nothing: a wheel without load, and one that is nearly standing,
/// that is |R omega| < 0.05 m/s (R: the wheel's radius) while the vehicle moves slower than 0.05
/// m/s. A vehicle that does not tell its wheels (`wheeled`) is judged by its own speed alone.
///
/// Results: slip_rms, slip_max, slip_rms_turn, slip_max_turn and slip_angle_rms_rad over all
/// wheels, slip_rms_<n> and slip_max_<n> of each. NaN where there are no wheels, or no turns;
/// of a vehicle that flies and has no wheels there are none.

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/metrics/metric_numbers.h"

namespace vinerow::metrics {

const std::vector<MetricNumber>& wheel_slip_numbers();
PartSpec wheel_slip_spec();
std::unique_ptr<Metric> make_wheel_slip(const ParameterSet& parameters,
                                        const MetricContext& context);

}  // namespace vinerow::metrics
