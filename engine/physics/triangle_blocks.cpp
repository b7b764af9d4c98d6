#include "engine/physics/triangle_blocks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "engine/physics/packet_rays.h"

namespace vinerow::physics {
namespace {

using Eigen::AlignedBox3f;
using Eigen::Vector3d;

/// Cost of a block, in surfaces of the box of a mean triangle. Chosen: among vines a third fewer
/// blocks than without it, and so less memory and time for Embree's trees; rays take as long.
constexpr double kBlockCost = 1.0;

/// Length of a slice, and how many there are at most: they bound what meshes of long, slanting
/// triangles take. A cut must save this share of the box's surface. Chosen: among vines with their
/// wires, 0.1 to 0.5 m and a half to four fifths take the same time; the longest make the fewest.
constexpr double kSlice_m = 0.5, kMostSlices = 16.0, kWorthwhile = 0.5;

/// PacketRays' numbers are at most 6 Q, with Q the largest coordinate of the block, since a ray
/// that meets it is within Q of z = 0 there: |x_0| <= (1 + S) Q, S = 2. The roundings of x_0, s_x,
/// the product and both differences add up to 17 Q 2^-24 < 1.1e-6 Q = m / 2; a nanometre exceeds
/// those of double precision. No corner is farther than X = (1 + S) B + m from a ray that meets the
/// block, B its longest side. So a product of two coordinates errs by 2 X m + m^2 and rounds by
/// 6e-8 X^2, the difference of two of them by twice that and once more.
float calc_area_error(const AlignedBox3f& box_M) {
  const float largest_m = box_M.min().cwiseAbs().cwiseMax(box_M.max().cwiseAbs()).maxCoeff();
  const float m = 2e-6f * largest_m + 1e-9f;
  const float most_m = (1.0f + PacketRays::kMostSlope) * box_M.sizes().maxCoeff() + m;
  return 4.0f * most_m * m + 2.0f * m * m + 4e-7f * most_m * most_m;
}

/// Half of the surface of a box.
template <class Scalar>
Scalar calc_surface(const Eigen::AlignedBox<Scalar, 3>& box) {
  const Eigen::Matrix<Scalar, 3, 1> size = box.sizes();
  return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
}

AlignedBox3f box_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  AlignedBox3f box_M;
  for (const std::uint32_t v : mesh.triangles[triangle]) box_M.extend(mesh.vertices[v]);
  return box_M;
}

using BlockCorners = std::array<Vector3d, 3>;

/// Calls use(corners) with each triangle of a block.
template <class Use>
void for_each_triangle(const TriangleBlock& block, const Use& use) {
  for (std::uint32_t i = 0; i < block.count; ++i) {
    BlockCorners corners;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) corners[corner][axis] = block.corners_M[corner][axis][i];
    }
    use(corners);
  }
}

TriangleBlock make_block(const TriangleMesh& mesh, std::uint32_t first, std::uint32_t count,
                         const AlignedBox3f& box_M) {
  TriangleBlock block{{}, first, static_cast<std::uint16_t>(count), 0, 1, calc_area_error(box_M)};
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

/// Adds the block, or its slices.
void add_block(TriangleBlock block, const AlignedBox3f& box_M, std::vector<TriangleBlock>& blocks) {
  const double length_m = box_M.sizes().maxCoeff();
  const auto slices =
      static_cast<std::uint8_t>(std::clamp(std::ceil(length_m / kSlice_m), 1.0, kMostSlices));
  const auto first = static_cast<std::ptrdiff_t>(blocks.size());
  if (slices > 1) {
    block.slices = slices;
    double surface_m2 = 0.0;
    for (block.slice = 0; block.slice < slices; ++block.slice) {
      surface_m2 += calc_surface(calc_box(block, Pose{}));
      blocks.push_back(block);
    }
    if (surface_m2 <= kWorthwhile * calc_surface(box_M)) return;
    blocks.erase(blocks.begin() + first, blocks.end());
    block.slice = 0;
    block.slices = 1;
  }
  blocks.push_back(block);
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
    const std::uint32_t first = end - least[end].last;
    AlignedBox3f box_M;
    for (std::uint32_t i = first; i < end; ++i) box_M.extend(box_of(mesh, i));
    add_block(make_block(mesh, first, least[end].last, box_M), box_M, blocks);
  }
  std::reverse(blocks.begin(), blocks.end());
  return blocks;
}

Eigen::AlignedBox3d calc_box(const TriangleBlock& block, const Pose& X) {
  const Eigen::Matrix3d R = X.q.toRotationMatrix();
  Eigen::AlignedBox3d box;
  if (block.slices == 1) {
    for_each_triangle(block, [&](const BlockCorners& corners) {
      for (const Vector3d& p : corners) box.extend(R * p + X.p);
    });
    return box;
  }
  Eigen::AlignedBox3d whole;
  for_each_triangle(block, [&](const BlockCorners& corners) {
    for (const Vector3d& p : corners) whole.extend(p);
  });
  Eigen::Index axis = 0;
  const double length_m = whole.sizes().maxCoeff(&axis) / block.slices;
  const double low_m = whole.min()[axis] + block.slice * length_m;
  const double high_m = whole.min()[axis] + (block.slice + 1) * length_m;
  // The corners in the slice, and where edges cross its ends.
  for_each_triangle(block, [&](const BlockCorners& corners) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d &from = corners[i], &to = corners[(i + 1) % 3];
      if (from[axis] >= low_m && from[axis] <= high_m) box.extend(R * from + X.p);
      for (const double end_m : {low_m, high_m}) {
        if ((from[axis] < end_m) == (to[axis] < end_m)) continue;
        const double share = (end_m - from[axis]) / (to[axis] - from[axis]);
        box.extend(R * (from + share * (to - from)) + X.p);
      }
    }
  });
  return box;
}

}  // namespace vinerow::physics
