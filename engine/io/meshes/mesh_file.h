#pragma once
/// Reader of triangle meshes: OBJ, STL, COLLADA (DAE), glTF/GLB, PLY and other formats of assimp.
///
/// Result frame: z up, metres. Axes and unit come from the file if the format defines them
/// (COLLADA: `up_axis` and `unit`; glTF: y up, metres). OBJ, STL and PLY do not; they are read as z
/// up, metres, unless the options differ. The rotation from y up to z up is
/// (x, y, z) -> (x, -z, y).

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/mesh.h"

namespace vinerow::io {

enum class UpAxis {
  kAuto,  ///< as in the file, else z
  kY,     ///< y up, regardless of the file
  kZ,     ///< z up, regardless of the file (as URDF reads every mesh)
};

struct MeshFileOptions {
  UpAxis up_axis = UpAxis::kAuto;
  double unit_m = 0.0;  ///< metres per unit of the file; 0 = as in the file, else 1
  Eigen::Vector3d scale = {1.0, 1.0, 1.0};  ///< applied last, in the result frame; != 0
  bool join_vertices =
      true;  ///< merge equal vertices; false keeps the file's vertices and their order
};

/// One mesh of one material.
struct MeshPart {
  std::string name;  ///< of the node in the file
  std::shared_ptr<const TriangleMesh> mesh;
  Material material;  ///< texture: absolute path of an existing file, or ""
};

struct MeshFile {
  std::vector<MeshPart> parts;     ///< in file order, never empty
  std::vector<std::string> notes;  ///< missing textures and libraries that the file names

  Eigen::AlignedBox3d bounds() const;  ///< of all parts, m
};

/// @throws ConfigError naming the file: it does not exist, is empty, is of an unknown format, is
/// broken (with assimp's
///         reason), has no triangles, or has a coordinate that is not finite or beyond 100 km.
MeshFile load_mesh(const std::filesystem::path& file, const MeshFileOptions& options = {});

/// Doubt about the unit of a file: CAD programs write millimetres, and OBJ, STL and PLY have no
/// unit.
/// @param bounds  of the mesh as it is read, m
/// @param max_m   largest believable size along x, y and z
/// @param remedy  for a file in millimetres, "set unit_m: 0.001"
/// @returns a sentence that names the file, "" if the size is believable
std::string doubt_unit(const std::filesystem::path& file, const Eigen::AlignedBox3d& bounds,
                       const Eigen::Vector3d& max_m, const std::string& remedy);

/// Joins all parts into one mesh, for collision. Colours and texture coordinates are dropped unless
/// every part has them.
TriangleMesh merge_parts(const MeshFile& file);

}  // namespace vinerow::io
