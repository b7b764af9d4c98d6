#pragma once
/// Folder of the mesh files of planted rows.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "worlds/plants/vine_rows.h"

namespace vinerow::worlds {

/// Folder whose name is the digest of everything that shapes the meshes of plant_vine_rows().
/// @param parent      empty: find_cache_folder()
/// @param kind        first part of the name
/// @param parameters  with those of planting_table()
/// @throws ConfigError as find_cache_folder()
std::filesystem::path planted_folder(const std::filesystem::path& parent, const std::string& kind,
                                     const ParameterSet& parameters,
                                     const std::vector<VineRow>& rows, const HeightField& terrain);

}  // namespace vinerow::worlds
