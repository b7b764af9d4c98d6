#pragma once
/// Distance, time, speed and energy of a vehicle.
///
/// Results: distance_m (arc length of the true track, summed at the metric's rate), time_s,
/// mean_speed_mps, max_speed_mps, energy_J (NaN where the vehicle has no battery), finished (1 or
/// 0).

#include <memory>

#include "engine/api/registry.h"

namespace vinerow {

PartSpec travel_spec();
std::unique_ptr<Metric> make_travel(const ParameterSet& parameters, const MetricContext& context);

}  // namespace vinerow
