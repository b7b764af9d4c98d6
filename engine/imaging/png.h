#pragma once
/// Reader and writer of PNG files, based on libpng.

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "engine/core/result.h"
#include "engine/imaging/pixels.h"

namespace vinerow::imaging {

/// Reads any PNG as 8-bit RGBA, top row first. @returns the pixels, or the error
Result<Pixels> read_png(const std::string& file);

/// Writes a PNG atomically, with fast compression and without time stamps: equal pixels give equal
/// files.
/// @throws WriteError, ConfigError if the file cannot be written
/// @param rgb    3 bytes per pixel, top row first
/// @param words  stored with the picture (chunks tEXt), by keyword; see read_png_words()
void write_png(const std::string& file, int width, int height, std::span<const std::uint8_t> rgb,
               const std::map<std::string, std::string>& words = {});

/// Texts stored before a PNG's pixels, by keyword. Empty if the file has no texts or is not a PNG.
std::map<std::string, std::string> read_png_words(const std::string& file);

/// Encodes a PNG in memory, optimised for size; without alpha if every pixel is opaque. It has no
/// time stamps, so equal pixels give equal bytes. @pre width and height >= 1
std::string encode_png(const Pixels& pixels);

}  // namespace vinerow::imaging
