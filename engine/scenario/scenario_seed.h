#pragma once
/// Operations on a scenario's resolved text: replacing the seed, extracting a key.

#include "engine/scenario/scenario.h"

namespace vinerow::scenario {

/// The scenario with another seed, like load_scenario with Overrides::seed (also its
/// `resolved_yaml`), but without reading the file again.
Scenario with_seed(Scenario scenario, std::uint64_t seed);

/// The resolved text of a top-level key with its whole value; "" if absent. Equal texts mean equal
/// values.
std::string resolved_block(const Scenario& scenario, const std::string& key);

}  // namespace vinerow::scenario
