#pragma once
/// Scale bar and north arrow of a map picture.

#include "engine/render/canvas.h"

namespace vinerow::render {

/// Longest length of 1, 2 or 5 times a power of ten metres that is at most `max_m`.
double scale_length_m(double max_m);

/// Draws a bar of such a length that ends at `right_end`, with its length above and an arrow to the
/// north (up) on its left.
/// @param wanted_m  upper limit of the bar's length
/// @param size  of text, lines and arrow; 1: text of 17 px
/// @returns the left end of the arrow, px
double draw_scale_bar(Canvas& canvas, const Eigen::Vector2d& right_end, double wanted_m,
                      double px_per_m, const Rgb& ink, double size = 1.0);

}  // namespace vinerow::render
