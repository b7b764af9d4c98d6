#pragma once
/// Every built-in estimator, planner and controller.

#include "engine/api/registry.h"

namespace vinerow::controllers {

void register_controllers(Registry& registry);

}  // namespace vinerow::controllers
