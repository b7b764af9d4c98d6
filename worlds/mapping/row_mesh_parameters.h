#pragma once
/// What can be said of the map `row_mesh` in a scenario.

#include <vector>

#include "engine/api/parameters.h"

namespace vinerow::worlds {

std::vector<ParameterSpec> row_mesh_parameters();

/// Refuses with a folder of meshes what only a survey can do. @throws ConfigError naming it
void check_folder_parameters(const ParameterSet& parameters);

}  // namespace vinerow::worlds
