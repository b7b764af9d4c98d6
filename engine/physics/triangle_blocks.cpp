#include "engine/physics/triangle_blocks.h"

#include <Eigen/Geometry>

namespace vinerow::physics {
namespace {

using Eigen::AlignedBox3f;

/// Half of the surface of a box.
float calc_surface(const AlignedBox3f& box) {
  const Eigen::Vector3f size = box.sizes();
  return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
}

TriangleBlock make_block(const TriangleMesh& mesh, std::uint32_t first, std::uint32_t count) {
  TriangleBlock block{{}, first, count};
  for (std::uint32_t i = 0; i < TriangleBlock::kSize; ++i) {
    const bool is_there = i < count;
    const auto& vertices = mesh.triangles[is_there ? first + i : first];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3f& p_M = mesh.vertices[vertices[is_there ? corner : 0]];
      for (int axis = 0; axis < 3; ++axis) block.corners_M[corner][axis][i] = p_M[axis];
    }
  }
  return block;
}

}  // namespace

std::vector<TriangleBlock> make_triangle_blocks(const TriangleMesh& mesh) {
  std::vector<TriangleBlock> blocks;
  AlignedBox3f box_M;  // of the triangles from `first` on
  std::uint32_t first = 0;
  const auto end = static_cast<std::uint32_t>(mesh.triangles.size());
  for (std::uint32_t i = 0; i < end; ++i) {
    AlignedBox3f triangle_M;
    for (const std::uint32_t v : mesh.triangles[i]) triangle_M.extend(mesh.vertices[v]);
    const AlignedBox3f common_M = box_M.merged(triangle_M);
    const bool joins = i > first && i - first < TriangleBlock::kSize &&
                       calc_surface(common_M) <= (calc_surface(box_M) + calc_surface(triangle_M));
    if (!joins && i > first) {
      blocks.push_back(make_block(mesh, first, i - first));
      first = i;
    }
    box_M = joins ? common_M : triangle_M;
  }
  if (first < end) blocks.push_back(make_block(mesh, first, end - first));
  return blocks;
}

}  // namespace vinerow::physics
