#pragma once
/// Row meshes as files.

#include <string>
#include <vector>

#include "engine/api/map.h"

namespace vinerow::mapping {

/// One PLY file per mesh, "row_03_hull_00.ply", into a folder that is made if need be; what it
/// holds of such files is replaced.
/// @throws ConfigError naming the file where it cannot be written
void save_meshes(const std::vector<RowMesh>& meshes, const std::string& folder);

/// What save_meshes() wrote, or your own files of such names. @throws ConfigError where there are
/// none, a name tells no row, or a file is broken
std::vector<RowMesh> load_meshes(const std::string& folder);

}  // namespace vinerow::mapping
