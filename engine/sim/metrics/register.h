#pragma once
#include "engine/api/registry.h"

namespace vinerow {

/// Adds the built-in metrics and the `truth` estimator: one line each.
void register_metrics(Registry& registry);

}  // namespace vinerow
