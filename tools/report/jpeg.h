#pragma once
/// JPEG encoder for the photographs of the page. PNG would keep every leaf but take five times the
/// bytes.

#include <string>

#include "engine/render/pixels.h"

namespace vinerow::tools::report {

/// Baseline JPEG (ITU-T T.81) in JFIF, colours at half the resolution (4:2:0), with the tables of
/// Annex K. The same pixels give the same bytes. Alpha is ignored.
/// @param quality  1 to 100, scaled as by the Independent JPEG Group
/// @pre width, height from 1 to 65535
std::string encode_jpeg(const render::Pixels& pixels, int quality);

}  // namespace vinerow::tools::report
