#pragma once
/// Registration of the built-in metrics.

#include "engine/api/registry.h"

namespace vinerow::metrics {

/// Adds the built-in metrics.
void register_metrics(Registry& registry);

}  // namespace vinerow::metrics
