#pragma once
/// Job `plan`: runs a vehicle's own planner before the phase that drives the plan.

#include "engine/api/registry.h"

namespace vinerow {

/// Registers the job. It plans for one vehicle from its present place, on the product `map` if
/// there is one.
void register_plan_job(Registry& registry);

}  // namespace vinerow
