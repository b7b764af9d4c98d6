#include "engine/physics/triangle_blocks.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace vinerow::physics {
namespace {

using Eigen::AlignedBox3f;

/// Cost of a block, in surfaces of the box of a mean triangle. Chosen: among vines a third fewer
/// blocks than without it, and so less memory and time for Embree's trees; rays take as long.
constexpr double kBlockCost = 1.0;

/// Half of the surface of a box.
float calc_surface(const AlignedBox3f& box) {
  const Eigen::Vector3f size = box.sizes();
  return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
}

AlignedBox3f box_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  AlignedBox3f box_M;
  for (const std::uint32_t v : mesh.triangles[triangle]) box_M.extend(mesh.vertices[v]);
  return box_M;
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
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  double alone = 0.0;
  for (std::uint32_t i = 0; i < count; ++i) alone += calc_surface(box_of(mesh, i));
  const double per_block = kBlockCost * alone / std::max(count, 1u);

  // Of the first triangles: the least cost of their blocks, and the size of the last block.
  struct Least {
    double cost = 0.0;
    std::uint32_t last = 0;
  };
  std::vector<Least> least(std::size_t{count} + 1);
  for (std::uint32_t end = 1; end <= count; ++end) {
    AlignedBox3f box_M;
    for (std::uint32_t size = 1; size <= std::min<std::uint32_t>(end, TriangleBlock::kSize);
         ++size) {
      box_M.extend(box_of(mesh, end - size));
      const double cost = least[end - size].cost + calc_surface(box_M) + per_block;
      if (size == 1 || cost < least[end].cost) least[end] = {cost, size};
    }
  }

  std::vector<TriangleBlock> blocks;
  for (std::uint32_t end = count; end > 0; end -= least[end].last) {
    blocks.push_back(make_block(mesh, end - least[end].last, least[end].last));
  }
  std::reverse(blocks.begin(), blocks.end());
  return blocks;
}

}  // namespace vinerow::physics
