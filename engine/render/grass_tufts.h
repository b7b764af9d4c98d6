#pragma once
/// Cards of grass around the camera: fixed to the ground, made anew for each frame.

#include <vector>

#include "engine/render/culling.h"
#include "engine/render/ground_mask.h"
#include "engine/render/mesh_preparation.h"

namespace vinerow::render {

/// Two crossed quads a tuft. Each cell of a fixed grid over the ground holds one tuft, whose place,
/// size and picture come from the cell's number alone; sizes fade to nothing at the range's end.
/// @param seen_scale  metres of seen distance per metre (see calc_seen_distance)
/// @param vertices,indices  replaced
void make_grass_tufts(const HeightField& field, const GroundMask& mask, const Camera& camera,
                      const Frustum& frustum, double seen_scale, std::vector<GpuVertex>& vertices,
                      std::vector<std::uint32_t>& indices);

}  // namespace vinerow::render
