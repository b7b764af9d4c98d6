#pragma once
/// Colours for numbers whose order the eye sees: viridis (S. van der Walt, N. Smith,
/// matplotlib 1.5, CC0), at eleven places, straight in between.

#include "tools/pictures/picture_canvas.h"

namespace vinerow::tools {

/// @param share  0 (dark violet) to 1 (yellow); limited to it
Rgb viridis(double share);

/// Round numbers for ticks over a range, at most `most` of them.
std::vector<double> ticks(double from, double to, int most);

}  // namespace vinerow::tools
