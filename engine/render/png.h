#pragma once
/// Reader and writer of PNG files, based on libpng.

#include <map>
#include <string>

#include "engine/core/result.h"
#include "engine/render/pixels.h"

namespace vinerow::render {

/// Reads any PNG as 8-bit RGBA, top row first. @returns the pixels, or the error
Result<Pixels> read_png(const std::string& file);

/// Texts stored before a PNG's pixels, by keyword. Empty if the file has no texts or is not a PNG.
std::map<std::string, std::string> read_png_words(const std::string& file);

/// Encodes a PNG in memory, optimised for size; without alpha if every pixel is opaque. It has no
/// time stamps, so equal pixels give equal bytes. @pre width and height >= 1
std::string encode_png(const Pixels& pixels);

}  // namespace vinerow::render
