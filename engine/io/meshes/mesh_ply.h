#pragma once
/// Reader of triangle meshes in PLY 1.0 files: ascii, and binary in both byte orders.
///
/// It reads these properties. Element "vertex": x y z, nx ny nz, s t (or u v, texture_u texture_v),
/// red green blue (bytes or 16-bit integers are sRGB, real numbers are linear). Element "face":
/// vertex_indices (or vertex_index), and texcoord for texture coordinates per corner; polygons are
/// cut into triangles. Element "tristrips": vertex_indices, -1 between strips. A comment
/// "TextureFile <name>" names the texture. Other properties and elements are ignored.
/// Source: G. Turk, "The PLY Polygon File Format", 1994.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/api/mesh.h"

namespace vinerow::io {

struct PlyMesh {
  TriangleMesh mesh;            ///< vertices, order, axes and unit as in the file
  bool linear_colours = false;  ///< the file's colours are real numbers
  std::string texture;          ///< as written; "": no texture
  std::vector<std::string> notes;
};

/// Memory is bounded by a small multiple of the file's size, regardless of the header.
/// @throws ConfigError naming the file: "... is cut off: ...", "... face 12 names vertex 9, it has
/// 3 (0 to 2)", a line with too few or too many numbers, no vertices
PlyMesh read_ply_mesh(const std::filesystem::path& file);

/// Merges vertices that are equal in all attributes into the first of them, and removes unused
/// vertices.
void join_equal_vertices(TriangleMesh& mesh);

}  // namespace vinerow::io
