#pragma once
/// Bare soil and grass by colour, in sun and in shade.
///
/// A pixel's soil colour is
///   (1 - a) log R + a log B - log G
/// of linear light, which the colour of the light hardly changes, from the sun's to that of the
/// blue sky in shadows, if 1 / l_G = a / l_B + (1 - a) / l_R with the wavelengths l of the filters
/// (Maddern et al., Illumination invariant imaging, ICRA workshop 2014). Plants are low, soil is
/// high.

#include <cstdint>
#include <span>

namespace vinerow::controllers {

/// @param rgb  sRGB of a pixel
float soil_colour(const std::uint8_t* rgb);

/// Mean colours of the two classes with the largest variance between them (Otsu, IEEE Trans. SMC 9,
/// 1979).
struct SoilClasses {
  float grass = 0.0f, soil = 0.0f;

  /// Whether they differ by more than grass from grass.
  bool differ() const;
  /// Share of soil: 0 at the mean of grass, 1 at that of soil.
  float share(float colour) const;
};
SoilClasses split_soil(std::span<const float> colours);

}  // namespace vinerow::controllers
