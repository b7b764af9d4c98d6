#pragma once
/// The same scenario for a run with another seed.

#include "engine/io/scenario.h"

namespace vinerow::io {

/// As load_scenario with Overrides::seed gives it, its `resolved_yaml` included, but without
/// reading the file again.
Scenario with_seed(Scenario scenario, std::uint64_t seed);

}  // namespace vinerow::io
