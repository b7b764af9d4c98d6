#pragma once
/// Tracking errors of a fixed-wing vehicle, and its use of the limits that its controller monitors.
///
/// Vehicles without wings have no such results. The metric compares the truth with the reference at
/// its rate while the reference's phase is straight or turn: the survey and the flight to and from
/// it, without launch, loiter and landing. Results:
///   height_error_rms_m, height_error_max_m: true height minus the reference's
///   heading_error_rms_deg: true heading of body x minus the reference's
///   straight_heading_error_rms_deg: the same in the phase straight
///   straight_cross_track_rms_m, straight_cross_track_max_m: in the phase straight, if the nearest
///     stretch of the plan is a leg: true distance from that leg in the plane
///   airspeed_error_rms_mps: true airspeed minus the reference's
///   bank_max_deg: largest absolute true roll
///   load_factor_max: largest specific force along body z, divided by g
///   limit_steps_lon_states, limit_steps_lon_inputs, limit_steps_lat_states,
///   limit_steps_lat_inputs: number of samples outside the limits
///   limit_share_max: largest used share of a limit; like the counts, from the controller's signal
///     "deviation"
///   landing_distance_m: true distance of the vehicle after landing from the point in "landing".

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/result_spec.h"

namespace vinerow::metrics {

const std::vector<ResultSpec>& air_tracking_results();
PartSpec air_tracking_spec();
std::unique_ptr<Metric> make_air_tracking(const ParameterSet& parameters,
                                          const MetricContext& context);

}  // namespace vinerow::metrics
