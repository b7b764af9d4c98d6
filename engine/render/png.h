#pragma once
/// PNG files, by libpng.

#include <map>
#include <string>

#include "engine/core/result.h"
#include "engine/render/pixels.h"

namespace vinerow::render {

/// Reads any PNG as 8-bit RGBA, top row first. @returns the pixels, or why there are none
Result<Pixels> read_png(const std::string& file);

/// Texts stored before a PNG's pixels, by keyword. Empty where the file has none or is no PNG.
std::map<std::string, std::string> read_png_words(const std::string& file);

/// A PNG file in memory, without alpha where every pixel is opaque; small more than fast to make.
/// No time stamps: the same pixels give the same bytes. @pre width and height >= 1
std::string encode_png(const Pixels& pixels);

}  // namespace vinerow::render
