#pragma once
/// Binary glTF scene in memory with 16-bit positions: half the size of floats, exact to 1/65534 of
/// a mesh's longest side.
///
/// Source: Khronos Group, "glTF 2.0 Specification", 2021 (ISO/IEC 12113:2022); extension
/// KHR_mesh_quantization.

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/math/pose.h"
#include "engine/render/mesh_preparation.h"

namespace vinerow::tools {

struct GlbMaterial {
  std::string name;
  Eigen::Vector3f colour = {1, 1, 1};  ///< linear RGB, multiplied with vertex colours
  float roughness = 0.9f;
  bool two_sided = false;
  bool leaf_cards = false;  ///< alpha mask; vertices have texture coordinates
};

class GlbScene {
 public:
  GlbScene();

  /// Adds a material, unless it exists. @returns its index
  int add_material(const GlbMaterial& material);

  /// Adds a mesh. @returns its index
  /// @param coloured  whether its vertex colours are used
  /// @param cards  whether it has texture coordinates, all in [0, 1]
  /// @pre the mesh has triangles, and its vertices are finite
  int add_mesh(const std::string& name, const render::PreparedMesh& mesh, int material,
               bool coloured, bool cards);

  /// Adds a node that shows a mesh. @param parent  index of a node, -1: the scene
  /// @param extras  object with data for programs
  int add_node(const std::string& name, int mesh, const Pose& X_PM, nlohmann::json extras = {},
               int parent = -1);
  /// Adds a node without mesh as a parent of others.
  int add_frame(const std::string& name, const Pose& X_PF, nlohmann::json extras = {});

  /// Content of the file. The root node's rotation turns z up into glTF's y up: (x, y, z) to
  /// (x, z, -y).
  std::string bytes() const;

 private:
  struct Placement {
    Eigen::Vector3d centre_M;  ///< m
    double step_m;             ///< length of one integer step
  };

  int add_accessor(const std::string& bytes, std::size_t stride, int component, const char* type,
                   std::size_t count, bool normalised, int target);

  nlohmann::json root_;
  std::string data_;
  std::vector<Placement> placements_;  ///< placements of meshes
};

}  // namespace vinerow::tools
