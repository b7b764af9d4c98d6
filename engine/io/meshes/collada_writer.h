#pragma once
/// Writer of one mesh as COLLADA 1.4.1, the format that robot viewers read with its colours.
///
/// STL has neither colours nor axes: Foxglove turns it by 90 degrees. RViz turns glTF, and shows
/// its linear colours too dark, because it takes them as sRGB.
/// Source: Khronos Group, "COLLADA - Digital Asset Schema Release 1.4.1", 2008.

#include <filesystem>

#include "engine/api/mesh.h"

namespace vinerow::io {

/// Writes metres, z up, and normals if the mesh has them. Each colour becomes a material, because
/// RViz ignores colours of vertices. A triangle has the mean colour of its corners, in 8 bits of
/// sRGB for each channel, or in fewer bits if there were more than 256 colours. Textures and
/// triangles without their vertices are left out.
/// @throws ConfigError naming the file: there are no triangles, a coordinate is not finite, or the
/// file cannot be written at this place; WriteError
void write_collada(const TriangleMesh& mesh, const Material& material,
                   const std::filesystem::path& file);

}  // namespace vinerow::io
