#pragma once
#include <string>
#include <string_view>

#include "engine/api/registry.h"
#include "engine/metrics/metric_numbers.h"

namespace vinerow::metrics {

/// Adds the built-in metrics.
void register_metrics(Registry& registry);

/// What a built-in metric declares of one of its results; nullptr: none of this name, or the type
/// is a plug-in's.
const MetricNumber* find_metric_number(const std::string& type, std::string_view name);

}  // namespace vinerow::metrics
