#pragma once
/// Overlay of an occupancy grid: occupied cells in translucent violet with a rim.
///
/// In orthographic views from above it is drawn over everything, so that the rectangles of rows
/// show through the canopy as on a map. Otherwise it is painted on the ground and its grass, which
/// avoids flicker.

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/render/gl.h"
#include "engine/render/scene.h"

namespace vinerow::render {

/// One mipmap level with two bytes per texel: occupied share (255: all), and depth inside the
/// occupied area (255: kGridDepth_m or more; 0: free).
struct GridLevel {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> texels;  ///< 2 * width * height, row 0 is the lowest y
};

/// Largest stored depth, m.
constexpr double kGridDepth_m = 2.0;

/// Mipmap levels of a grid, each of half the size. A texel has the largest occupied share of the
/// four texels below, so that a wall of one cell is visible from afar, and their mean depth. Edges
/// of the first level are blurred by one cell. Sizes are multiples of 64 (the last cells are
/// repeated) and at most 8192 per side (cells of larger grids are merged). Everything beyond the
/// grid counts as occupied.
/// @param cells_a_texel  receives the width of a texel of the first level in cells
std::vector<GridLevel> make_grid_levels(const OccupancyGrid& grid, int& cells_a_texel);

/// True if the overlay is drawn over everything.
bool is_map_view(const Camera& camera);

/// Texture of the grid, created when a frame first shows it. Do not copy it: the texture belongs to
/// the context.
class GridOverlay {
 public:
  explicit GridOverlay(const Gl& gl) : gl_(gl) {}
  /// Uploads the grid unless it is the current one. Changes the active texture unit.
  void show(const std::shared_ptr<const OccupancyGrid>& grid);
  /// Sets the uniforms for the grid's position in the program in use.
  /// @param rect,size  locations of `grid_rect` and `grid_size`
  void set_place(GLint rect, GLint size) const;

 private:
  const Gl& gl_;
  std::shared_ptr<const OccupancyGrid> shown_;
  GLuint texture_ = 0;
  float rect_[4] = {0, 0, 0, 0};  ///< corner in m, 1 / size of the texture
  float size_[4] = {0, 0, 0, 0};  ///< of the grid in m, of a texel in m
};

}  // namespace vinerow::render
