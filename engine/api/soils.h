#pragma once
/// The built-in soils, so that worlds can name one and vehicles feel the same numbers.
///
/// Sources of the numbers: vehicles/parts/README.md.

#include <span>
#include <string>
#include <vector>

#include "engine/api/world_model.h"

namespace vinerow {

/// In the order of the table in vehicles/parts/README.md.
std::span<const Soil> built_in_soils();

/// Names of the built-in soils, for parameter choices.
std::vector<std::string> soil_names();

/// @throws ConfigError "unknown soil 'dry_gras'; did you mean 'dry_grass'? (known: ...)"
const Soil& soil_by_name(const std::string& name);

}  // namespace vinerow
