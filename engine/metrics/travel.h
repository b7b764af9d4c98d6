#pragma once
/// Distance, time, speed and energy of a vehicle.
///
/// Results: distance_m (arc length of the true track, summed at the metric's rate), displacement_m
/// (straight distance from the start), standing_drift_m (largest displacement while stationary),
/// time_s, mean_speed_mps, max_speed_mps, energy_J and mean_power_W (NaN if the vehicle has no
/// battery), battery_hours (battery_capacity_J divided by the mean power; NaN if the capacity is
/// unknown or the mean power is not positive), finished (1 or 0; never 1 after a crash).

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/result_spec.h"

namespace vinerow::metrics {

const std::vector<ResultSpec>& travel_results();
PartSpec travel_spec();
std::unique_ptr<Metric> make_travel(const ParameterSet& parameters, const MetricContext& context);

}  // namespace vinerow::metrics
