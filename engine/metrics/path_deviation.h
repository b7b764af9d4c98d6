#pragma once
/// How well the true track follows the plan.
///
/// Source: paper B (Martelli 2024), section 3 and eq. 8, as settled in engine/math/deviation.h.
/// Results over the whole mission, samples at the metric's rate (default: the controller's) plus
/// the start:
///   average_deviation_m (ATD), deviation_max_m, oscillation_count (OF), relative_accuracy_per_m =
///   1/(ATD OF), all from the polyline of the plan's points (in the plane, of a flight in space)
/// and on the legs, where the plants are (stretches of kind kLeg):
///   cross_track_rms_m, cross_track_max_m, heading_error_rms_rad, leg_samples
/// and in the turns, from the plan's arcs (PlanStretch::curve_distance_m):
///   turn_deviation_rms_m, turn_deviation_max_m.
/// Also planned_length_m and alleys_driven: of those in which the plan has a leg, how many were
/// passed from the leg's begin to its end (tenths.h).

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/metrics/metric_numbers.h"

namespace vinerow::metrics {

const std::vector<MetricNumber>& path_deviation_numbers();
PartSpec path_deviation_spec();
std::unique_ptr<Metric> make_path_deviation(const ParameterSet& parameters,
                                            const MetricContext& context);

}  // namespace vinerow::metrics
