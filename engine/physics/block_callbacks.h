#pragma once
/// What Embree's search of a tree calls: a ray in the search, the boxes of blocks of triangles, and
/// the tests of those whose boxes rays meet. Part of MeshRays.

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/math/pose.h"
#include "engine/physics/mesh_trees.h"
#include "engine/physics/packet_rays.h"
#include "engine/physics/triangle_blocks.h"
#include "engine/physics/triangle_ray.h"

namespace vinerow::physics {

/// Mesh instances, in the order of Embree's geometry ids.
struct PlacedMesh {
  const MeshInstance* instance;
  int mesh_index;
  bool stands_once;
  const Lazy<MeshTrees::Tree>* tree;  ///< for the first rays; may be null
  Eigen::Matrix3d R_MW;
  Eigen::Vector3d p_MW;
};

/// Data of a geometry's callback: its triangles, and the margin of its boxes.
struct BlockBoxes {
  const std::vector<TriangleBlock>* blocks;
  Pose X;           ///< the boxes are in the frame of X * (corner)
  double margin_m;  ///< error bound of a ray in single precision
};

/// A ray in Embree's tree traversal.
struct RayLane {
  // Some ray where there is none: the packet's are all transformed.
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero(), dir_W = Eigen::Vector3d::UnitZ();
  double tree_start_m = 0.0;  ///< distance along the ray at which Embree's ray starts
  // The ray in the frame of the last tested mesh.
  unsigned entry = RTC_INVALID_GEOMETRY_ID;
  TriangleRay ray_M;
  // The nearest hit so far. Among hits at the same distance, the one of the first mesh and
  // triangle, so that it does not depend on the traversal order.
  double best_m = 0.0;
  unsigned best_entry = RTC_INVALID_GEOMETRY_ID;
  unsigned best_triangle = 0;
  const TriangleBlock* best_block = nullptr;  ///< that contains it; null: found without Embree

  bool has_hit() const { return best_entry != RTC_INVALID_GEOMETRY_ID; }

  /// Takes over the ray in the frame of a mesh.
  VINEROW_ALWAYS_INLINE void enter(const PlacedMesh& placed, unsigned entry_of_mesh) {
    if (entry_of_mesh == entry) return;
    ray_M = TriangleRay(placed.R_MW * p_W + placed.p_MW, placed.R_MW * dir_W);
    entry = entry_of_mesh;
  }

  /// Takes over a triangle of the entered mesh. @returns true if it is the nearest hit so far
  VINEROW_ALWAYS_INLINE bool take(double found_m, unsigned triangle) {
    if (found_m > best_m) return false;
    if (found_m == best_m && has_hit() &&
        std::pair(best_entry, best_triangle) < std::pair(entry, triangle)) {
      return false;
    }
    best_m = found_m;
    best_entry = entry;
    best_triangle = triangle;
    return true;
  }

  /// @returns true if a triangle of the block is the nearest hit so far
  VINEROW_ALWAYS_INLINE bool test(const PlacedMesh& placed, unsigned entry_of_block,
                                  const TriangleBlock& block) {
    enter(placed, entry_of_block);
    double found_m[TriangleBlock::kSize];
    const unsigned met = ray_M.distances_m(block, found_m);
    bool is_nearest = false;
    for (unsigned left = met; left != 0; left &= left - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(left));
      if (!take(found_m[i], block.first + i)) continue;
      best_block = &block;
      is_nearest = true;
    }
    return is_nearest;
  }

  void test(const PlacedMesh& placed, unsigned entry_of_triangle, unsigned triangle) {
    enter(placed, entry_of_triangle);
    const TriangleMesh& mesh = *placed.instance->mesh;
    const auto& [a, b, c] = mesh.triangles[triangle];
    const auto found_m = ray_M.distance_m(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    if (found_m && take(*found_m, triangle)) best_block = nullptr;
  }
};

using RayLanes = std::array<RayLane, kPacket>;

/// What the traversal passes to the callback. A ray's id is the number of its lane.
struct RayCast : RTCIntersectContext {
  const std::vector<PlacedMesh>* placed;
  double margin_m;
  RayLane* lanes;
  unsigned first_in_packet = 0;  ///< lane of the first ray of a packet
  PacketRays packet;
};

struct BlockFunctions {
  RTCIntersectFunctionN look;
  RTCOccludedFunctionN block;
};
/// The fastest versions on this processor. All have the same bits.
BlockFunctions block_functions();
/// Box of a block, widened by the margin, for Embree.
void find_block_box(const RTCBoundsFunctionArguments* arguments);

}  // namespace vinerow::physics
