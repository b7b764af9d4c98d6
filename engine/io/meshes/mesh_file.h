#pragma once
/// Triangle meshes from files: OBJ, STL, COLLADA (DAE), glTF/GLB, PLY and what else assimp reads.
///
/// Result frame: z up, metres. Axes and unit come from the file where the format says them
/// (COLLADA: `up_axis` and `unit`; glTF: y up, metres); OBJ, STL and PLY say nothing and are taken
/// as z up, metres, unless the caller knows better. A rotation from y up to z up maps (x, y, z) to
/// (x, -z, y).

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/mesh.h"

namespace vinerow::io {

enum class UpAxis {
  kAuto,  ///< what the file says, else z
  kY,     ///< the file's numbers have y up, whatever it says
  kZ,     ///< the file's numbers have z up, whatever it says (URDF's reading of every mesh)
};

struct MeshFileOptions {
  UpAxis up_axis = UpAxis::kAuto;
  double unit_m = 0.0;  ///< metres per unit of the file; 0 = what the file says, else 1
  Eigen::Vector3d scale = {1.0, 1.0, 1.0};  ///< applied last, in the result frame; != 0
  bool join_vertices =
      true;  ///< share equal vertices; off keeps the file's vertices and their order
};

/// One mesh of one material.
struct MeshPart {
  std::string name;  ///< of the node in the file
  std::shared_ptr<const TriangleMesh> mesh;
  Material material;  ///< texture: absolute path of an existing file, or ""
};

struct MeshFile {
  std::vector<MeshPart> parts;  ///< in file order, never empty
  std::vector<std::string>
      notes;  ///< textures and libraries that the file names and that are not there, each by name

  Eigen::AlignedBox3d bounds() const;  ///< of all parts, m
};

/// @throws ConfigError naming the file: it does not exist, is empty, is of an unknown format, is
/// broken (with assimp's
///         reason), has no triangles, or has a coordinate that is not finite.
MeshFile load_mesh(const std::filesystem::path& file, const MeshFileOptions& options = {});

/// All parts as one mesh, for collision. Colours and texture coordinates are dropped unless every
/// part has them.
TriangleMesh merge_parts(const MeshFile& file);

}  // namespace vinerow::io
