#include "engine/imaging/pixels.h"

#include <algorithm>
#include <cmath>

namespace vinerow::imaging {

namespace {

Pixels halve_pixels(const Pixels& from, bool weight_by_alpha) {
  Pixels to(std::max(1, from.width / 2), std::max(1, from.height / 2));
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      double sum[3] = {0, 0, 0};
      double alpha = 0.0;
      double weight = 0.0;
      for (int k = 0; k < 4; ++k) {
        const int sx = std::min(2 * x + (k & 1), from.width - 1);
        const int sy = std::min(2 * y + (k >> 1), from.height - 1);
        const std::uint8_t* p = from.at(sx, sy);
        // A small weight keeps the colour defined if all four are transparent.
        const double w = weight_by_alpha ? p[3] + 0.01 : 1.0;
        for (int c = 0; c < 3; ++c) sum[c] += w * p[c];
        alpha += 0.25 * p[3];
        weight += w;
      }
      std::uint8_t* out = to.at(x, y);
      for (int c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>(std::lround(sum[c] / weight));
      out[3] = static_cast<std::uint8_t>(std::lround(alpha));
    }
  }
  return to;
}

}  // namespace

int texture_side(double cells) {
  int n = 1;
  while (n < cells && n < 2048) n *= 2;
  return n;
}

std::vector<Pixels> mip_chain(const Pixels& base) {
  std::vector<Pixels> levels = {base};
  while (levels.back().width > 1 || levels.back().height > 1) {
    levels.push_back(halve_pixels(levels.back(), false));
  }
  return levels;
}

double alpha_coverage(const Pixels& pixels, double scale) {
  std::size_t covered = 0;
  const std::size_t count = pixels.rgba.size() / 4;
  for (std::size_t i = 0; i < count; ++i) {
    if (pixels.rgba[4 * i + 3] * scale >= 127.5) ++covered;
  }
  return static_cast<double>(covered) / static_cast<double>(count);
}

std::vector<Pixels> mip_chain_with_coverage(const Pixels& base) {
  std::vector<Pixels> levels = {base};
  const double wanted = alpha_coverage(base);
  while (levels.back().width > 1 || levels.back().height > 1) {
    levels.push_back(halve_pixels(levels.back(), true));
  }
  for (std::size_t level = 1; level < levels.size(); ++level) {
    double low = 0.25;
    double high = 6.0;
    for (int step = 0; step < 12; ++step) {
      const double middle = 0.5 * (low + high);
      (alpha_coverage(levels[level], middle) < wanted ? low : high) = middle;
    }
    for (std::size_t i = 3; i < levels[level].rgba.size(); i += 4) {
      const double alpha = levels[level].rgba[i] * high;
      levels[level].rgba[i] = static_cast<std::uint8_t>(std::lround(std::min(255.0, alpha)));
    }
  }
  return levels;
}

}  // namespace vinerow::imaging
