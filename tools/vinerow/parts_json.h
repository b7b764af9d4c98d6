#pragma once
/// JSON description of a part and its parameters, for programs.

#include <nlohmann/json.hpp>
#include <string>

#include "engine/api/registry.h"

namespace vinerow::tools {

/// Limits and defaults that a parameter lacks are left out. @pre the registry has the part
nlohmann::ordered_json part_json(const Registry& registry, PartKind kind, const std::string& name);

}  // namespace vinerow::tools
