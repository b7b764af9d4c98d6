#pragma once
/// A metric's values at each level of a factor: a box each, and the values themselves.

#include <cstdint>
#include <string>
#include <vector>

#include "tools/study/plots/frame.h"
#include "tools/study/plots/marks.h"
#include "tools/study/plots/quantity.h"

namespace vinerow::study {

struct BoxValue {
  double value = kNoValue;  ///< NaN: counted in the tip, not drawn
  std::int64_t cell = kNoCell;
  std::string note;
};

struct BoxLevel {
  std::string label;
  std::vector<BoxValue> values;
};

struct BoxPlot {
  PlotTexts texts;
  Quantity x;                    ///< the factor
  Quantity y;                    ///< the metric
  std::vector<BoxLevel> levels;  ///< from left to right
};

/// Levels of no more values than this show each of them; others show their outliers.
inline constexpr std::size_t kMostDots = 50;

/// <figure>; "" where no value can be drawn. Dots that would cover each other stand side by side.
std::string box_plot(const BoxPlot& plot);

}  // namespace vinerow::study
