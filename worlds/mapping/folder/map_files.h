#pragma once
/// Files of row meshes.

#include <string>
#include <vector>

#include "engine/api/map.h"

namespace vinerow::mapping {

/// Writes one PLY file per mesh, "row_03_hull_00.ply", to a folder, which is created if necessary.
/// Files of such names in it are replaced.
/// @throws ConfigError naming a file that cannot be written
void save_meshes(const std::vector<RowMesh>& meshes, const std::string& folder);

/// Reads the files of save_meshes(), or others of such names.
/// @throws ConfigError if there are no files, a name contains no row, or a file is broken
std::vector<RowMesh> load_meshes(const std::string& folder);

}  // namespace vinerow::mapping
