#pragma once
/// PNG files, by libpng.

#include <string>

#include "engine/core/result.h"
#include "engine/render/pixels.h"

namespace vinerow::render {

/// Reads any PNG as 8-bit RGBA, top row first. @returns the pixels, or why there are none
Result<Pixels> read_png(const std::string& file);

}  // namespace vinerow::render
