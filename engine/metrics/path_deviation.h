#pragma once
/// Deviation of the true track from the plan.
///
/// Source: paper B (Martelli 2024), section 3 and eq. 8, as interpreted in engine/math/deviation.h.
/// Results over the whole mission, from samples at the metric's rate (default: the controller's)
/// and the start:
///   average_deviation_m (ATD), deviation_max_m, oscillation_count (OF), relative_accuracy_per_m =
///   1/(ATD OF), all from the polyline of the plan's points (in the plane; for a flight, in space)
/// On the legs, between the plants (stretches of kind kLeg):
///   cross_track_rms_m, cross_track_max_m, heading_error_rms_rad, leg_samples
/// In the turns, from the plan's arcs (PlanStretch::curve_distance_m):
///   turn_deviation_rms_m, turn_deviation_max_m.
/// Also planned_length_m, and alleys_driven: number of alleys whose leg of the plan was passed from
/// its start to its end (tenths.h).

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/result_spec.h"

namespace vinerow::metrics {

const std::vector<ResultSpec>& path_deviation_results();
PartSpec path_deviation_spec();
std::unique_ptr<Metric> make_path_deviation(const ParameterSet& parameters,
                                            const MetricContext& context);

}  // namespace vinerow::metrics
