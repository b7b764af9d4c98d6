#pragma once
/// An entry of a picture's legend.

#include <cstdint>
#include <string>

#include "tools/pictures/picture_canvas.h"

namespace vinerow::tools {

/// A patch of colour with its words to the right of it.
/// @param x, y  upper left corner of the patch
void draw_legend_patch(Canvas& canvas, double x, double y, const Rgb& colour,
                       const std::string& words);

/// "15 %". What is there and is less than half a percent is "< 1 %": pictures show it.
std::string share_text(std::int64_t part, std::int64_t all);

}  // namespace vinerow::tools
