#pragma once
/// Box plot of a metric at each level of a factor, with single values.

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

/// A level with at most this many values shows each of them, others only their outliers.
inline constexpr std::size_t kMaxDots = 50;

/// <figure>; "" if no value can be drawn. Dots that would cover each other are placed side by side.
std::string box_plot(const BoxPlot& plot);

}  // namespace vinerow::study
