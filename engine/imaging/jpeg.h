#pragma once
/// JPEG files, for photographs. PNG would keep every leaf but take five times the bytes.

#include <span>
#include <string>

#include "engine/core/result.h"
#include "engine/imaging/pixels.h"

namespace vinerow::imaging {

/// Baseline JPEG in JFIF with colours at half the resolution (4:2:0). The same pixels give the same
/// bytes with the same libjpeg. Alpha is ignored.
/// @param quality  1 to 100, as of libjpeg
/// @param segments  contents of APP1 segments (Exif, XMP), at most 65,533 bytes each
/// @pre width, height from 1 to 65535
/// @throws std::runtime_error if memory is exhausted
std::string encode_jpeg(const Pixels& pixels, int quality,
                        std::span<const std::string> segments = {});

/// Reads a JPEG in grey or colours as opaque RGBA, top row first. A file that ends early is
/// refused.
/// @returns the pixels, or the error
Result<Pixels> read_jpeg(const std::string& file);

}  // namespace vinerow::imaging
