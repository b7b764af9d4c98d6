#pragma once
/// Distance, time, speed and energy of a vehicle.
///
/// Results: distance_m (arc length of the true track, summed at the metric's rate), displacement_m
/// (straight from the start to where it is now), time_s, mean_speed_mps, max_speed_mps, energy_J
/// and mean_power_W (NaN where the vehicle has no battery), battery_hours (its
/// battery_capacity_J over the mean power; NaN where it tells none or draws none), finished (1 or
/// 0; never after a crash).

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/metrics/metric_numbers.h"

namespace vinerow::metrics {

const std::vector<MetricNumber>& travel_numbers();
PartSpec travel_spec();
std::unique_ptr<Metric> make_travel(const ParameterSet& parameters, const MetricContext& context);

}  // namespace vinerow::metrics
