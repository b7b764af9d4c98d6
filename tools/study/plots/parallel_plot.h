#pragma once
/// Parallel plot of all factors and metrics: one axis each, one line per setting.

#include <cstdint>
#include <string>
#include <vector>

#include "tools/study/plots/frame.h"
#include "tools/study/plots/marks.h"
#include "tools/study/plots/quantity.h"

namespace vinerow::study {

struct ParallelAxis {
  Quantity quantity;
  /// Texts of the levels, from bottom to top; a line's value is then an index. Empty for a numeric
  /// axis.
  std::vector<std::string> levels;
};

struct ParallelLine {
  std::vector<double> values;  ///< one per axis; NaN: gap in the line
  std::int64_t cell = kNoCell;
  std::string note;
};

struct ParallelPlot {
  PlotTexts texts;
  std::vector<ParallelAxis> axes;  ///< the last axis colours the lines
  std::vector<ParallelLine> lines;
  std::size_t max_lines = 2000;  ///< of more lines, this many are drawn, evenly chosen
};

/// <figure>; "" with fewer than two axes or without lines.
/// @pre each line has as many values as there are axes; max_lines > 0
std::string parallel_plot(const ParallelPlot& plot);

}  // namespace vinerow::study
