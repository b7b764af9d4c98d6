#pragma once
#include "engine/api/registry.h"

namespace vinerow {

/// Every built-in part, from every folder.
void register_all(Registry& registry);

}  // namespace vinerow
