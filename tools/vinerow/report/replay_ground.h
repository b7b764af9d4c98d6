#pragma once
/// The ground of a replay: terrain as meshes, and the country around it.

#include <vector>

#include "engine/api/height_field.h"
#include "engine/render/mesh_preparation.h"

namespace vinerow::tools {

/// The triangles of a height field as meshes of at most 65 535 vertices, neighbours sharing their
/// border. Split as HeightField splits its cells.
std::vector<render::PreparedMesh> terrain_meshes(const HeightField& field);

}  // namespace vinerow::tools
