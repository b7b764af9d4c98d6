#pragma once
/// Conversion of a TriangleMesh for the GPU: compact vertices with normals, and choice of card
/// pictures.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::render {

struct GpuVertex {
  float position[3];
  std::int8_t normal[4];  ///< x, y, z / 127
  float uv[2];
  std::uint8_t colour[4];  ///< sqrt(linear RGB) * 255; a: layer of the card texture
};
static_assert(sizeof(GpuVertex) == 28);

struct PreparedMesh {
  std::vector<GpuVertex> vertices;
  std::vector<std::uint32_t> indices;
  bool closed = false;  ///< every edge has its opposite and the volume is positive: one-sided
  Eigen::AlignedBox3d bounds_M;
};

enum class CardKind { kNone, kVine, kTree };

/// Triangles with an index beyond the vertices are dropped.
PreparedMesh prepare_mesh(const TriangleMesh& mesh, CardKind cards);

}  // namespace vinerow::render
