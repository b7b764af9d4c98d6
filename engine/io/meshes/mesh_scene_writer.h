#pragma once
/// Writers of several named meshes to one file, for other programs: Wavefront OBJ, binary glTF 2.0,
/// and one joined mesh for write_ply().

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/api/mesh.h"

namespace vinerow::io {

struct NamedMesh {
  std::string name;                    ///< "row_03_hull_00"; no line breaks
  const TriangleMesh* mesh = nullptr;  ///< m, z up
};

/// Writes text: one object per mesh, `o name`, vertices to 0.1 mm, no materials. OBJ does not
/// define axes: the file has z up, like the map. Blender and MeshLab ask for the axes or show the
/// numbers as they are.
/// @throws ConfigError as write_glb
void write_obj(std::span<const NamedMesh> meshes, const std::filesystem::path& file);

/// Writes one node per mesh below a root node that rotates z up to glTF's y up, (x, y, z) to (x, z,
/// -y); the vertex data keep z up. Vertices are float, indices have 16 bits if they fit, there are
/// no normals (viewers then use flat shading), and all meshes share one material.
/// @throws ConfigError naming the file: no mesh has triangles, a coordinate is not finite, or the
/// file cannot be written completely
void write_glb(std::span<const NamedMesh> meshes, const std::filesystem::path& file,
               const Material& material);

/// Material of sunlit leaves.
Material canopy_material();

/// Joins all vertices and triangles in order, without normals, colours and texture coordinates.
TriangleMesh join_meshes(std::span<const NamedMesh> meshes);

}  // namespace vinerow::io
