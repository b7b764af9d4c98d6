#pragma once
/// JPEG encoder for the photographs of the page. PNG would keep every leaf but take five times the
/// bytes.

#include <string>

#include "engine/imaging/pixels.h"

namespace vinerow::tools::report {

/// Baseline JPEG in JFIF with colours at half the resolution (4:2:0). The same pixels give the same
/// bytes with the same libjpeg. Alpha is ignored.
/// @param quality  1 to 100, as of libjpeg
/// @pre width, height from 1 to 65535
/// @throws std::runtime_error if memory is exhausted
std::string encode_jpeg(const imaging::Pixels& pixels, int quality);

}  // namespace vinerow::tools::report
