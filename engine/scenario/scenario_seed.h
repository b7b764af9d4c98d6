#pragma once
/// What can be said of a scenario by its resolved text: the same with another seed, one of its
/// keys.

#include "engine/scenario/scenario.h"

namespace vinerow::scenario {

/// As load_scenario with Overrides::seed gives it, its `resolved_yaml` included, but without
/// reading the file again.
Scenario with_seed(Scenario scenario, std::uint64_t seed);

/// The resolved text of a top-level key with all that stands below it; "" where it is absent. Equal
/// texts mean equal values.
std::string resolved_block(const Scenario& scenario, const std::string& key);

}  // namespace vinerow::scenario
