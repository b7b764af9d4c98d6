#pragma once
/// Textures on the CPU side: 8-bit RGBA pixels and their mipmaps.

#include <cstdint>
#include <vector>

namespace vinerow::imaging {

struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< row 0 first; 4 bytes per pixel

  Pixels() = default;
  Pixels(int w, int h) : width(w), height(h), rgba(static_cast<std::size_t>(w) * h * 4) {}
  std::uint8_t* at(int x, int y) { return &rgba[(static_cast<std::size_t>(y) * width + x) * 4]; }
  const std::uint8_t* at(int x, int y) const {
    return &rgba[(static_cast<std::size_t>(y) * width + x) * 4];
  }
};

/// Side of a texture for a number of cells: the next power of two, at most 2048.
int texture_side(double cells);

/// Level 0 is `base`, each further level half the size (2x2 mean) down to 1x1.
/// Powers of two only.
std::vector<Pixels> mip_chain(const Pixels& base);

/// The same for alpha-tested cards. The mean of colours is weighted by alpha, so that no background
/// bleeds in. Alpha is scaled per level so that the share of pixels with alpha >= 0.5 equals that
/// of level 0: foliage does not thin out with distance. Source: I. Castano, "Computing alpha
/// mipmaps", 2010.
std::vector<Pixels> mip_chain_with_coverage(const Pixels& base);

/// Share of pixels with alpha >= 0.5 after alpha is multiplied by `scale`.
double alpha_coverage(const Pixels& pixels, double scale = 1.0);

}  // namespace vinerow::imaging
