#pragma once
/// Triangles of a mesh in groups of four, so that a ray is tested against all four at once by
/// vector instructions.

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/math/pose.h"

namespace vinerow::physics {

/// One to four successive triangles of a mesh.
struct TriangleBlock {
  static constexpr std::size_t kSize = 4;
  /// Coordinates [corner][axis][triangle]. Triangles that the block lacks are points, which no ray
  /// meets.
  float corners_M[3][3][kSize];
  std::uint32_t first;  ///< of its triangles in the mesh
  std::uint16_t count;
  std::uint8_t slice, slices;  ///< its box surrounds one of these slices across its longest axis
  float area_error;            ///< bound of the error of twice a signed area in PacketRays, m^2
};

/// Groups the triangles in the order of the mesh, with the least cost of all blocks: the surface of
/// a block's box, to which the chance that a ray meets it is proportional, and something for the
/// block itself. Meshes list the triangles of a leaf, a post or a hull one after the other; a
/// search for nearer ones takes longer than its better groups save.
///
/// The box of a wire at an angle to the axes is mostly empty. Such a block is there several times,
/// each with a slice of the box.
std::vector<TriangleBlock> make_triangle_blocks(const TriangleMesh& mesh);

/// Box of the block's slice, placed by X.
Eigen::AlignedBox3d calc_box(const TriangleBlock& block, const Pose& X);

}  // namespace vinerow::physics
