#pragma once
/// How well a vehicle on wings holds what its guidance wants, and how near it comes to the limits
/// its controller watches.
///
/// Vehicles without wings have no such results. Judged at the metric's rate by the truth, while the
/// reference's phase is straight or turn: the survey and the ways to and from it, without launch,
/// loiter and landing. Results:
///   height_error_rms_m, height_error_max_m: true height less the reference's
///   heading_error_rms_deg: true heading of body x less the reference's
///   straight_heading_error_rms_deg: the same in the phase straight
///   straight_cross_track_rms_m, straight_cross_track_max_m: in the phase straight, where the
///   plan's
///     nearest stretch is a leg: true distance from that leg in the plane
///   airspeed_error_rms_mps: true airspeed less the reference's
///   bank_max_deg: largest true roll, to either side
///   load_factor_max: largest lift direction's share of weight, specific force along body z / g
///   limit_steps_lon_states, limit_steps_lon_inputs, limit_steps_lat_states,
///   limit_steps_lat_inputs: ticks outside the limits, and limit_share_max: the largest share of a
///     limit that was used, both as the controller's "deviation" tells.

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/metrics/metric_numbers.h"

namespace vinerow::metrics {

const std::vector<MetricNumber>& air_tracking_numbers();
PartSpec air_tracking_spec();
std::unique_ptr<Metric> make_air_tracking(const ParameterSet& parameters,
                                          const MetricContext& context);

}  // namespace vinerow::metrics
