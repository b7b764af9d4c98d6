#pragma once
/// The job `plan`: a vehicle's own planner, run before the phase that drives its plan.

#include "engine/api/registry.h"

namespace vinerow {

/// Takes a `map` if given, gives the plan of one vehicle from where it stands.
void register_plan_job(Registry& registry);

}  // namespace vinerow
