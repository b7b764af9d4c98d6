#pragma once
/// Slip of the wheels along their rolling direction, over the whole run and in the turns.
///
/// Reads "wheels", the diagnostics of a wheeled vehicle: wheel_<n>_slip = (R omega - v_x) /
/// max(|R omega|, |v_x|) and wheel_<n>_slip_angle_rad (vehicles/parts/wheel.h). Every sample counts
/// once, so their rate is the scenario's record.truth_rate_Hz. "In turns" means that the nearest
/// part of the vehicle's plan is a turn (PlanStretch).
///
/// Samples without meaning are ignored: a wheel without load, and a wheel with |R omega| < 0.05 m/s
/// (R: the wheel's radius) while the vehicle moves slower than 0.05 m/s. If the description has no
/// wheels (`wheeled`), only the vehicle's speed is considered.
///
/// Results: slip_rms, slip_max, slip_rms_turn, slip_max_turn and slip_angle_rms_rad over all
/// wheels, slip_rms_<n> and slip_max_<n> of each wheel. NaN without wheels or turns. Flying
/// vehicles without wheels have no such results.

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/result_spec.h"

namespace vinerow::metrics {

const std::vector<ResultSpec>& wheel_slip_results();
PartSpec wheel_slip_spec();
std::unique_ptr<Metric> make_wheel_slip(const ParameterSet& parameters,
                                        const MetricContext& context);

}  // namespace vinerow::metrics
