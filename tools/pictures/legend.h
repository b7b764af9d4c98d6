#pragma once
/// Legend entries of pictures.

#include <cstdint>
#include <functional>
#include <string>

#include "tools/pictures/picture_canvas.h"

namespace vinerow::tools {

/// Draws a horizontal bar of colours with a thin edge. @param colour  of a share of its length
void draw_colour_bar(Canvas& canvas, double left, double top, double width, double height,
                     const std::function<Rgb(double share)>& colour);

/// Draws a patch of colour with its text to the right.
/// @param x, y  upper left corner of the patch
void draw_legend_patch(Canvas& canvas, double x, double y, const Rgb& colour,
                       const std::string& words);

/// "15 %". A share above 0 but below 0.5 % is "< 1 %".
std::string share_text(std::int64_t part, std::int64_t all);

}  // namespace vinerow::tools
