#pragma once
/// Planner `coverage`: drives every alley of a row map with turns in the headlands (paper B,
/// section 2.3).

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec coverage_spec();

/// @throws ConfigError if an alley is listed that the map does not have, or listed twice
std::unique_ptr<Planner> make_coverage(const ParameterSet& parameters,
                                       const PlannerContext& context);

}  // namespace vinerow::controllers
