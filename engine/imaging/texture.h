#pragma once
/// Pictures on surfaces: files, and their colours at a place, in linear light.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/imaging/pixels.h"

namespace vinerow::imaging {

/// Reads a PNG or JPEG file as 8-bit RGBA, top row first. @returns the pixels, or the error
Result<Pixels> read_image(const std::string& file);

/// A picture that repeats over the plane, with smaller versions of itself for distant surfaces.
/// Mixes light, not sRGB numbers. No heap after construction, thread safe.
class Texture {
 public:
  /// @param pixels  sRGB; not empty
  explicit Texture(const Pixels& pixels);

  /// Linear RGB in [0, 1]. (u, v) = (0, 0) is the lower left corner, (1, 1) the upper right one.
  /// @param spot  width of what is wanted, in the units of u and v: finer detail is averaged
  Eigen::Vector3f colour(double u, double v, double spot) const;

 private:
  struct Level {
    int width, height;
    std::vector<std::array<std::uint16_t, 3>> linear;  ///< 65535: 1; top row first
  };
  static Eigen::Vector3f sample(const Level& level, double u, double v);

  std::vector<Level> levels_;
};

}  // namespace vinerow::imaging
