#pragma once
/// Colour values: sRGB, as files and screens have them, and linear intensity, in which light adds
/// up. Source: IEC 61966-2-1:1999.

#include <cmath>

namespace vinerow {

/// @param value  sRGB of one channel, in [0, 1] @returns its linear intensity
inline double linear_from_srgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

/// @param linear  intensity of one channel, in [0, 1] @returns its sRGB value
inline double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

}  // namespace vinerow
