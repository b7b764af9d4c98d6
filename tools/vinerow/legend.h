#pragma once
/// An entry of a picture's legend.

#include <string>

#include "tools/vinerow/canvas.h"

namespace vinerow::tools {

/// A patch of colour with its words to the right of it.
/// @param x, y  upper left corner of the patch
void draw_legend_patch(Canvas& canvas, double x, double y, const Rgb& colour,
                       const std::string& words);

}  // namespace vinerow::tools
