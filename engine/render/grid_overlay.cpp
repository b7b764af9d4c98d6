#include "engine/render/grid_overlay.h"

#include <algorithm>
#include <cmath>

#include "engine/api/messages/grid.h"
#include "engine/render/texture_units.h"

namespace vinerow::render {

namespace {

constexpr int kPadding = 64;
constexpr int kLevels = 7;  // the last is 1/64 of the first
constexpr int kLargestSide = 8192;

int padded(int size) {
  return (size + kPadding - 1) / kPadding * kPadding;
}

/// Bytes of a plane with a padded size.
struct BytePlane {
  int width, height;
  std::vector<std::uint8_t> bytes;

  BytePlane(int w, int h) : width(w), height(h), bytes(static_cast<std::size_t>(w) * h) {}
  std::uint8_t* row(int y) { return &bytes[static_cast<std::size_t>(y) * width]; }
  const std::uint8_t* row(int y) const { return &bytes[static_cast<std::size_t>(y) * width]; }
};

/// 1 occupied, 0 free.
BytePlane occupancy_of(const OccupancyGrid& grid, int cells_a_texel) {
  const auto texels = [&](int cells) { return (cells - 1) / cells_a_texel + 1; };
  const int width = texels(grid.columns), height = texels(grid.rows);
  BytePlane occupancy(padded(width), padded(height));
  for (int j = 0; j < grid.rows; ++j) {
    const std::uint8_t* in = &grid.cells[static_cast<std::size_t>(j) * grid.columns];
    std::uint8_t* out = occupancy.row(j / cells_a_texel);
    for (int i = 0; i < grid.columns; ++i) {
      if (in[i] != 0) out[i / cells_a_texel] = 1;
    }
  }
  for (int y = 0; y < height; ++y) {
    std::fill(occupancy.row(y) + width, occupancy.row(y) + occupancy.width,
              occupancy.row(y)[width - 1]);
  }
  for (int y = height; y < occupancy.height; ++y) {
    std::copy_n(occupancy.row(height - 1), occupancy.width, occupancy.row(y));
  }
  return occupancy;
}

/// Blur with weights 1 2 1 along each side; 255: fully occupied.
BytePlane soften(const BytePlane& occupancy) {
  BytePlane along(occupancy.width, occupancy.height), soft(occupancy.width, occupancy.height);
  const auto blend = [](int before, int here, int after) {
    return static_cast<std::uint8_t>(before + 2 * here + after);
  };
  for (int y = 0; y < occupancy.height; ++y) {
    const std::uint8_t* in = occupancy.row(y);
    std::uint8_t* out = along.row(y);
    const int last = occupancy.width - 1;
    out[0] = blend(in[0], in[0], in[1]);
    for (int x = 1; x < last; ++x) out[x] = blend(in[x - 1], in[x], in[x + 1]);
    out[last] = blend(in[last - 1], in[last], in[last]);
  }
  for (int y = 0; y < occupancy.height; ++y) {
    const std::uint8_t* below = along.row(std::max(y - 1, 0));
    const std::uint8_t* here = along.row(y);
    const std::uint8_t* above = along.row(std::min(y + 1, occupancy.height - 1));
    std::uint8_t* out = soft.row(y);
    for (int x = 0; x < occupancy.width; ++x) {
      out[x] = static_cast<std::uint8_t>(blend(below[x], here[x], above[x]) * 255 / 16);
    }
  }
  return soft;
}

/// Distance of occupied texels to free ones, from centre to edge; 255: kGridDepth_m or more.
/// Chamfer distances in two sweeps (G. Borgefors, "Distance transformations in digital images",
/// 1986): 3 for a side, 4 for a diagonal.
BytePlane depths_of(const BytePlane& occupancy, double texel_m) {
  constexpr int kFar = 1 << 14;
  const int width = occupancy.width, height = occupancy.height;
  const double scale = 255.0 * texel_m / (3.0 * kGridDepth_m);
  const int stride = width + 2;  // a border of far texels avoids bounds checks
  std::vector<std::uint16_t> depth(static_cast<std::size_t>(stride) * (height + 2), kFar);
  const auto at = [&](int x, int y) {
    return &depth[static_cast<std::size_t>(y + 1) * stride + x + 1];
  };
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* in = occupancy.row(y);
    for (int x = 0; x < width; ++x) *at(x, y) = in[x] ? kFar : 0;
  }
  const auto sweep = [&](int x, int y, int step) {
    std::uint16_t* d = at(x, y);
    if (*d == 0) return;
    const std::uint16_t* other = d - step * stride;
    const int best = std::min({d[-step] + 3, other[0] + 3, other[-1] + 4, other[1] + 4});
    *d = static_cast<std::uint16_t>(std::min<int>(*d, best));
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) sweep(x, y, 1);
  }
  BytePlane out(width, height);
  for (int y = height - 1; y >= 0; --y) {
    for (int x = width - 1; x >= 0; --x) {
      sweep(x, y, -1);
      const double value = scale * std::max(0.0, *at(x, y) - 1.5);
      out.row(y)[x] = static_cast<std::uint8_t>(std::min(255.0, value + 0.5));
    }
  }
  return out;
}

/// Level of half the size; sizes are even.
GridLevel halve_level(const GridLevel& from) {
  GridLevel to{from.width / 2, from.height / 2, {}};
  to.texels.resize(2 * static_cast<std::size_t>(to.width) * to.height);
  for (int y = 0; y < to.height; ++y) {
    const std::uint8_t* low = &from.texels[static_cast<std::size_t>(4 * y) * from.width];
    const std::uint8_t* high = low + 2 * from.width;
    std::uint8_t* out = &to.texels[static_cast<std::size_t>(2 * y) * to.width];
    for (int x = 0; x < to.width; ++x, low += 4, high += 4, out += 2) {
      out[0] = std::max({low[0], low[2], high[0], high[2]});
      out[1] = static_cast<std::uint8_t>((low[1] + low[3] + high[1] + high[3] + 2) / 4);
    }
  }
  return to;
}

}  // namespace

std::vector<GridLevel> make_grid_levels(const OccupancyGrid& grid, int& cells_a_texel) {
  cells_a_texel = 1;
  const int longest = std::max(grid.columns, grid.rows);
  while ((longest - 1) / cells_a_texel >= kLargestSide) cells_a_texel *= 2;
  const BytePlane occupancy = occupancy_of(grid, cells_a_texel);
  const BytePlane soft = soften(occupancy);
  const BytePlane depth = depths_of(occupancy, grid.cell_m * cells_a_texel);

  GridLevel first{occupancy.width, occupancy.height, {}};
  first.texels.resize(2 * occupancy.bytes.size());
  for (std::size_t i = 0; i < occupancy.bytes.size(); ++i) {
    first.texels[2 * i] = soft.bytes[i];
    first.texels[2 * i + 1] = depth.bytes[i];
  }
  std::vector<GridLevel> levels = {std::move(first)};
  while (levels.size() < kLevels) levels.push_back(halve_level(levels.back()));
  return levels;
}

bool is_map_view(const Camera& camera) {
  return camera.orthographic && (camera.X_WC.q * Eigen::Vector3d::UnitZ()).z() < -0.999;
}

void GridOverlay::show(const std::shared_ptr<const OccupancyGrid>& grid) {
  if (grid == shown_) return;
  shown_ = grid;
  int cells_a_texel = 1;
  const std::vector<GridLevel> levels = make_grid_levels(*grid, cells_a_texel);
  const double texel_m = grid->cell_m * cells_a_texel;
  rect_[0] = static_cast<float>(grid->corner_W.x());
  rect_[1] = static_cast<float>(grid->corner_W.y());
  rect_[2] = static_cast<float>(1.0 / (levels[0].width * texel_m));
  rect_[3] = static_cast<float>(1.0 / (levels[0].height * texel_m));
  size_[0] = static_cast<float>(grid->columns * grid->cell_m);
  size_[1] = static_cast<float>(grid->rows * grid->cell_m);
  size_[2] = static_cast<float>(texel_m);

  if (texture_ == 0) gl_.GenTextures(1, &texture_);
  gl_.ActiveTexture(GL_TEXTURE0 + kUnitGrid);
  gl_.BindTexture(GL_TEXTURE_2D, texture_);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 2);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    gl_.TexImage2D(GL_TEXTURE_2D, static_cast<GLint>(i), GL_RG8, levels[i].width, levels[i].height,
                   0, GL_RG, GL_UNSIGNED_BYTE, levels[i].texels.data());
  }
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, kLevels - 1);
}

void GridOverlay::set_place(GLint rect, GLint size) const {
  gl_.Uniform4f(rect, rect_[0], rect_[1], rect_[2], rect_[3]);
  gl_.Uniform4f(size, size_[0], size_[1], size_[2], size_[3]);
}

}  // namespace vinerow::render
