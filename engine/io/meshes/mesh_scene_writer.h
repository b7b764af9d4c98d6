#pragma once
/// Several named meshes in one file, for other programs: Wavefront OBJ, binary glTF 2.0, and as one
/// mesh for write_ply().
///
/// Source: Khronos Group, "glTF 2.0 Specification", 2021 (ISO/IEC 12113:2022), 3.6 and 4.4.

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

/// Text: one object per mesh, `o name`, vertices to 0.1 mm, no materials. OBJ says nothing about
/// axes: these are z up, as the map is; Blender and MeshLab ask for them or show them as they are.
/// @throws ConfigError as write_glb
void write_obj(std::span<const NamedMesh> meshes, const std::filesystem::path& file);

/// One node per mesh below a root node that turns z up to glTF's y up, (x, y, z) to (x, z, -y): the
/// data stay as they are. Vertices as float, indices as 16 bits where they fit, no normals (viewers
/// then shade the faces flat), one material for all.
/// @throws ConfigError naming the file: no mesh with triangles, a coordinate that is not finite, or
/// it cannot be written completely
void write_glb(std::span<const NamedMesh> meshes, const std::filesystem::path& file,
               const Material& material);

/// Leaves in the sun.
Material canopy_material();

/// All vertices and triangles in order, without normals, colours and texture coordinates.
TriangleMesh join_meshes(std::span<const NamedMesh> meshes);

}  // namespace vinerow::io
