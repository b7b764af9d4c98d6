#pragma once
/// Binary glTF scene in memory with 16-bit positions: half the size of floats, exact to 1/65534 of
/// a mesh's longest side.
///
/// Source: Khronos Group, glTF 2.0 extension KHR_mesh_quantization.

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/io/meshes/glb_writer.h"
#include "engine/math/pose.h"
#include "engine/render/mesh_preparation.h"

namespace vinerow::tools {

class GlbScene : private io::GlbWriter {
 public:
  GlbScene();

  /// Adds a material, unless it exists. @returns its index
  int add_material(const Material& look, bool two_sided);

  /// Adds a mesh. @returns its index
  /// @param coloured  whether its vertex colours are used
  /// @param cards  whether it has texture coordinates, all in [0, 1]
  /// @pre the mesh has triangles, and its vertices are finite
  int add_mesh(const std::string& name, const render::PreparedMesh& mesh, int material,
               bool coloured, bool cards);

  /// Adds a node that shows a mesh. @param parent  index of a node, 0: the root
  /// @param extras  object with data for programs
  int add_node(const std::string& name, int mesh, const Pose& X_PM, nlohmann::json extras = {},
               int parent = 0);
  /// Adds a node without mesh as a parent of others.
  int add_frame(const std::string& name, const Pose& X_PF, nlohmann::json extras = {});

  using GlbWriter::bytes;

 private:
  struct Placement {
    Eigen::Vector3d centre_M;  ///< m
    double step_m;             ///< length of one integer step
  };

  std::vector<Placement> placements_;  ///< placements of meshes
};

}  // namespace vinerow::tools
