#pragma once
/// Triangles of PLY 1.0 files: ascii, binary in both byte orders.
///
/// Of the element "vertex": x y z, nx ny nz, s t (or u v, texture_u texture_v), red green blue
/// (bytes or 16-bit integers are what a screen shows, real numbers are linear). Of "face":
/// vertex_indices (or vertex_index) and, where a corner has texture coordinates of its own,
/// texcoord; polygons are cut into triangles. Of "tristrips": vertex_indices, -1 between strips. A
/// comment "TextureFile <name>" names the picture. Other properties and elements are skipped.
/// Source: G. Turk, "The PLY Polygon File Format", 1994.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/api/mesh.h"

namespace vinerow::io {

struct PlyMesh {
  TriangleMesh mesh;            ///< vertices and their order as in the file, axes and unit too
  bool linear_colours = false;  ///< real numbers
  std::string texture;          ///< as written, "": none
  std::vector<std::string> notes;
};

/// Memory stays within a small multiple of the file's size, whatever its header says.
/// @throws ConfigError naming the file: "... is cut off: ...", "... face 12 names vertex 9, it has
/// 3 (0 to 2)", a line with too few or too many numbers, no vertices
PlyMesh read_ply_mesh(const std::filesystem::path& file);

/// Makes one of vertices that are equal in all they have, the first, and leaves out those that no
/// triangle uses.
void join_equal_vertices(TriangleMesh& mesh);

}  // namespace vinerow::io
