#pragma once
/// Values with their intervals, a row each: probabilities of settings, sizes of effects.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/plots/frame.h"
#include "tools/study/plots/marks.h"
#include "tools/study/plots/quantity.h"

namespace vinerow::study {

struct IntervalRow {
  std::string label;
  double value = kNoValue;                 ///< NaN: the row says that it is not measured
  double low = kNoValue, high = kNoValue;  ///< its interval, where known; may be infinite
  std::string note;
  std::int64_t cell = kNoCell;
};

/// A value to compare with: no effect, or what is required.
struct IntervalReference {
  double value = 0.0;
  std::string label;
};

struct IntervalPlot {
  PlotTexts texts;
  Quantity value;
  std::string rows_title;         ///< what the rows are: "setting"
  std::string spread_label;       ///< "95 % interval"
  std::vector<IntervalRow> rows;  ///< from top to bottom
  std::optional<IntervalReference> reference;
};

/// <figure>; "" where there are no rows. With a reference, dots are hollow where the interval
/// contains it.
std::string interval_plot(const IntervalPlot& plot);

}  // namespace vinerow::study
