#pragma once
/// All factors and metrics of many settings at once: an axis for each, a line for each setting.

#include <cstdint>
#include <string>
#include <vector>

#include "tools/study/plots/frame.h"
#include "tools/study/plots/marks.h"
#include "tools/study/plots/quantity.h"

namespace vinerow::study {

struct ParallelAxis {
  Quantity quantity;
  /// Texts of the levels, from bottom to top; a line's value is then an index into them. Empty for
  /// an axis of numbers.
  std::vector<std::string> levels;
};

struct ParallelLine {
  std::vector<double> values;  ///< one for each axis; NaN: the line has a gap there
  std::int64_t cell = kNoCell;
  std::string note;
};

struct ParallelPlot {
  PlotTexts texts;
  std::vector<ParallelAxis> axes;  ///< the last one colours the lines
  std::vector<ParallelLine> lines;
  std::size_t most_lines = 2000;  ///< of more, so many are chosen evenly; the caption says so
};

/// <figure>; "" where there are fewer than two axes or no line.
/// @pre each line has as many values as there are axes; most_lines > 0
std::string parallel_plot(const ParallelPlot& plot);

}  // namespace vinerow::study
