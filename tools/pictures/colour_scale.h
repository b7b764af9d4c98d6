#pragma once
/// Colour scale viridis (S. van der Walt, N. Smith, matplotlib 1.5, CC0): eleven colours, linear in
/// between.

#include "tools/pictures/picture_canvas.h"

namespace vinerow::tools {

/// @param share  0 (dark violet) to 1 (yellow); clamped
Rgb viridis(double share);

/// At most `max_count` round numbers for ticks over a range.
std::vector<double> ticks(double from, double to, int max_count);

}  // namespace vinerow::tools
