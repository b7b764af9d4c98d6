#pragma once
/// Binary glTF 2.0 file in memory, part by part.
///
/// Source: Khronos Group, "glTF 2.0 Specification", 2021 (ISO/IEC 12113:2022), 3.6 and 4.4.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "engine/api/mesh.h"

namespace vinerow::io {

/// Component types of the specification.
enum class GlbNumber {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126
};

/// Attribute of a mesh's vertices.
struct GlbAttribute {
  const char* name;  ///< "POSITION"
  const char* type;  ///< "VEC3"
  GlbNumber number;
  std::string bytes;         ///< of all vertices; a multiple of four for each
  bool normalised = false;   ///< integers are fractions of their largest value
  nlohmann::json low, high;  ///< bounds, required of positions
};

class GlbWriter {
 public:
  /// Scene with one node, number 0, whose rotation turns z up into glTF's y up: (x, y, z) to
  /// (x, z, -y).
  GlbWriter();

  /// @param material  an object as in the specification @returns its index; an equal one is shared
  int add_material(nlohmann::json material);
  /// Adds triangles. @param corners  three for each; stored in 16 bits if that is enough
  /// @returns the mesh's index
  int add_mesh(const std::string& name, std::size_t vertices,
               std::span<const GlbAttribute> attributes, std::span<const std::uint32_t> corners,
               int material);
  /// @returns the node's index
  int add_node(nlohmann::json node, int parent = 0);

  /// Content of the file, which may be at most 4 GiB long.
  std::string bytes() const;

 protected:
  nlohmann::json root_;

 private:
  int add_accessor(const std::string& bytes, nlohmann::json view, nlohmann::json accessor);

  std::string data_;
};

/// Look of a mesh without pictures. Vertex colours multiply its colour.
nlohmann::json glb_material(const Material& look);

}  // namespace vinerow::io
