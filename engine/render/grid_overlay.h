#pragma once
/// An occupancy grid over the picture: taken cells in translucent violet with a rim.
///
/// Seen straight from above (orthographic) it lies over everything, so that row quads are seen
/// through their canopy as on a map; otherwise it is painted on the ground and its grass, where
/// nothing can flicker.

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/render/gl.h"
#include "engine/render/scene.h"

namespace vinerow::render {

/// One mipmap level, two bytes a texel: how much of it is taken (255: all), and how deep inside
/// what is taken it lies (255: kGridDepth_m or more; 0 where it is free).
struct GridLevel {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> texels;  ///< 2 * width * height, row 0 is the lowest y
};

/// Depths are told up to here, m.
constexpr double kGridDepth_m = 2.0;

/// Levels of a grid, each half the size: as taken as the most taken of the four texels below, so
/// that a wall of one cell is seen from far, and of their mean depth. The first level's edges are
/// softened by a cell. Sizes are multiples of 64, its last cells repeated, and at most 8192 a side
/// (cells of larger grids are joined). Beyond the grid everything counts as taken.
/// @param cells_a_texel  how many cells of the grid a texel of the first level is wide
std::vector<GridLevel> make_grid_levels(const OccupancyGrid& grid, int& cells_a_texel);

/// True where the overlay lies over everything.
bool is_map_view(const Camera& camera);

/// The grid's texture; made when a frame first shows it. Not copied, the texture is one of the
/// context.
class GridOverlay {
 public:
  explicit GridOverlay(const Gl& gl) : gl_(gl) {}
  /// Uploads unless it is the one already there. Leaves the active texture unit changed.
  void show(const std::shared_ptr<const OccupancyGrid>& grid);
  /// Sets the uniforms of the program in use that say where the grid lies.
  /// @param rect,size  places of `grid_rect` and `grid_size`
  void set_place(GLint rect, GLint size) const;

 private:
  const Gl& gl_;
  std::shared_ptr<const OccupancyGrid> shown_;
  GLuint texture_ = 0;
  float rect_[4] = {0, 0, 0, 0};  ///< corner in m, 1 / size of the texture
  float size_[4] = {0, 0, 0, 0};  ///< of the grid in m, of a texel in m
};

}  // namespace vinerow::render
