#pragma once
/// Grass cards around the camera, fixed to the ground and recomputed for each frame.

#include <span>
#include <vector>

#include "engine/api/scenery.h"
#include "engine/imaging/ground_mask.h"
#include "engine/render/culling.h"
#include "engine/render/mesh_preparation.h"

namespace vinerow::render {

/// Ground on which grass grows.
struct GrassGround {
  const HeightField& field;
  const imaging::GroundMask& mask;
  std::span<const SceneryTrack> tracks;  ///< without grass
  double bare = 0.0;                     ///< share of the ground without grass (GroundLook)
};

/// Two crossed quads per tuft. Each cell of a fixed ground grid has one tuft; its position, size
/// and picture depend only on the cell's index. Sizes fade to zero at the end of the range.
/// @param seen_scale  metres of seen distance per metre (see calc_seen_distance)
/// @param vertices,indices  replaced
void make_grass_tufts(const GrassGround& ground, const Camera& camera, const Frustum& frustum,
                      double seen_scale, std::vector<GpuVertex>& vertices,
                      std::vector<std::uint32_t>& indices);

}  // namespace vinerow::render
