#include "engine/physics/block_callbacks.h"

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>

namespace vinerow::physics {
namespace {

using Eigen::Vector3d;

/// Instance of the mesh whose block a search has reached: its place among the meshes.
unsigned entry_of(const RTCIntersectContext& context, unsigned geometry) {
  return context.instID[0] != RTC_INVALID_GEOMETRY_ID ? context.instID[0] : geometry;
}

/// Bit i: ray i of the arguments may meet a triangle of the block. Of a single ray the exact test
/// takes no longer than this one.
VINEROW_ALWAYS_INLINE unsigned find_near(RayCast& cast, const PlacedMesh& placed, unsigned entry,
                                         const TriangleBlock& block, const int* valid,
                                         unsigned count) {
  if (count != kPacket) {
    unsigned is_valid = 0;
    for (unsigned i = 0; i < count; ++i) is_valid |= static_cast<unsigned>(valid[i] != 0) << i;
    return is_valid;
  }
  const unsigned is_valid = bits_of_eight(valid);
  if (cast.packet.entry != entry) {
    cast.packet.enter(placed.R_MW, placed.p_MW, entry, cast.lanes, cast.first_in_packet);
  }
  return is_valid & cast.packet.find_near(block);
}

/// Called if rays meet the box of a block: one, or those of a packet.
VINEROW_ALWAYS_INLINE void look_at_block(const RTCIntersectFunctionNArguments* arguments) {
  auto& cast = *static_cast<RayCast*>(arguments->context);
  const auto& boxes = *static_cast<const BlockBoxes*>(arguments->geometryUserPtr);
  const unsigned entry = entry_of(cast, arguments->geomID);
  const PlacedMesh& placed = (*cast.placed)[entry];
  const TriangleBlock& block = (*boxes.blocks)[arguments->primID];
  const unsigned count = arguments->N;
  RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, count);
  RTCHitN* hits = RTCRayHitN_HitN(arguments->rayhit, count);
  for (unsigned near = find_near(cast, placed, entry, block, arguments->valid, count); near != 0;
       near &= near - 1) {
    const auto i = static_cast<unsigned>(std::countr_zero(near));
    RayLane& lane = cast.lanes[RTCRayN_id(rays, count, i)];
    if (!lane.test(placed, entry, block)) continue;
    // Skip boxes that start farther away; test those at the same distance.
    RTCRayN_tfar(rays, count, i) =
        static_cast<float>(lane.best_m - lane.tree_start_m + cast.margin_m);
    RTCHitN_geomID(hits, count, i) = arguments->geomID;
  }
}

/// The same for rays that only ask whether they meet anything.
VINEROW_ALWAYS_INLINE void block_rays(const RTCOccludedFunctionNArguments* arguments) {
  auto& cast = *static_cast<RayCast*>(arguments->context);
  const auto& boxes = *static_cast<const BlockBoxes*>(arguments->geometryUserPtr);
  const unsigned entry = entry_of(cast, arguments->geomID);
  const TriangleBlock& block = (*boxes.blocks)[arguments->primID];
  const PlacedMesh& placed = (*cast.placed)[entry];
  for (unsigned near = find_near(cast, placed, entry, block, arguments->valid, arguments->N);
       near != 0; near &= near - 1) {
    const auto i = static_cast<unsigned>(std::countr_zero(near));
    RayLane& lane = cast.lanes[RTCRayN_id(arguments->ray, arguments->N, i)];
    if (!lane.test(placed, entry, block)) continue;
    RTCRayN_tfar(arguments->ray, arguments->N, i) = -std::numeric_limits<float>::infinity();
  }
}

}  // namespace

void find_block_box(const RTCBoundsFunctionArguments* arguments) {
  const auto& boxes = *static_cast<const BlockBoxes*>(arguments->geometryUserPtr);
  const Eigen::AlignedBox3d box = calc_box((*boxes.blocks)[arguments->primID], boxes.X);
  const auto low = [&](int axis) { return static_cast<float>(box.min()[axis] - boxes.margin_m); };
  const auto high = [&](int axis) { return static_cast<float>(box.max()[axis] + boxes.margin_m); };
  *arguments->bounds_o = {low(0), low(1), low(2), 0.0f, high(0), high(1), high(2), 0.0f};
}

BlockFunctions block_functions() {
#if defined(__x86_64__)
  struct Avx {
    __attribute__((target("avx"))) static void look(const RTCIntersectFunctionNArguments* a) {
      look_at_block(a);
    }
    __attribute__((target("avx"))) static void block(const RTCOccludedFunctionNArguments* a) {
      block_rays(a);
    }
  };
  if (__builtin_cpu_supports("avx")) return {Avx::look, Avx::block};
#endif
  return {[](const RTCIntersectFunctionNArguments* arguments) { look_at_block(arguments); },
          [](const RTCOccludedFunctionNArguments* arguments) { block_rays(arguments); }};
}

}  // namespace vinerow::physics
