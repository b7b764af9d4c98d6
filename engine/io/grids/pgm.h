#pragma once
/// Reader and writer of portable graymaps (PGM), the pictures of ROS maps.

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vinerow::io {

/// Gray values, top row first.
struct GrayImage {
  int width = 0;
  int height = 0;
  int maximum = 255;                  ///< grey value of white, 1 to 65535
  std::vector<std::uint16_t> values;  ///< width * height, each at most `maximum`
};

/// Reads P5 (binary, one or two bytes a pixel) and P2 (text), with comments.
/// @throws ConfigError naming the file: missing, another format, invalid sizes, truncated, values
/// above the maximum
GrayImage read_pgm(const std::filesystem::path& file);

/// Writes P5 with `maximum` 255 or less. @throws ConfigError if the file cannot be written
void write_pgm(const std::filesystem::path& file, const GrayImage& image);

}  // namespace vinerow::io
