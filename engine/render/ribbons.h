#pragma once
/// Lines of constant pixel width as triangles in clip space.

#include <cstdint>
#include <vector>

#include "engine/render/scene.h"

namespace vinerow::render {

struct RibbonVertex {
  float clip[4];
  std::uint8_t colour[4];  ///< sRGB and alpha
  float along_px;          ///< from the line's start; -1 for solid lines
};
static_assert(sizeof(RibbonVertex) == 24);

/// Triangles (three vertices each) of a polyline, with joints rounded by short fans.
///
/// The line is lifted above the terrain, cut at the near plane, and moved towards the eye by
/// `bias_m`, so that grass and the ground's roughness do not hide it while posts and rows do.
/// @param line  @pre fade is empty or as long as points_W
/// @param field  may be null
std::vector<RibbonVertex> make_ribbon(const Polyline& line, const HeightField* field,
                                      const Eigen::Matrix4d& clip_from_world, const Camera& camera,
                                      int width_px, int height_px);

/// Moves a ribbon into another clip space.
void transform(std::vector<RibbonVertex>& ribbon, const Eigen::Matrix4d& matrix);

/// Sets the opacity of a ribbon. @param alpha  0 to 1
void set_alpha(std::vector<RibbonVertex>& ribbon, float alpha);

}  // namespace vinerow::render
