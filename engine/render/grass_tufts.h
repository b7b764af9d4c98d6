#pragma once
/// Cards of grass around the camera: fixed to the ground, made anew for each frame.

#include <span>
#include <vector>

#include "engine/api/scenery.h"
#include "engine/render/culling.h"
#include "engine/render/ground_mask.h"
#include "engine/render/mesh_preparation.h"

namespace vinerow::render {

/// What grass grows on.
struct GrassGround {
  const HeightField& field;
  const GroundMask& mask;
  std::span<const SceneryTrack> tracks;  ///< nothing grows there
  double bare = 0.0;                     ///< share of the ground without grass (GroundLook)
};

/// Two crossed quads a tuft. Each cell of a fixed grid over the ground holds one tuft, whose place,
/// size and picture come from the cell's number alone; sizes fade to nothing at the range's end.
/// @param seen_scale  metres of seen distance per metre (see calc_seen_distance)
/// @param vertices,indices  replaced
void make_grass_tufts(const GrassGround& ground, const Camera& camera, const Frustum& frustum,
                      double seen_scale, std::vector<GpuVertex>& vertices,
                      std::vector<std::uint32_t>& indices);

}  // namespace vinerow::render
