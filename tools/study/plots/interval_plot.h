#pragma once
/// Plot of values with intervals, one row each: probabilities of settings, sizes of effects.

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
  double value = kNoValue;                 ///< NaN: the row shows "not measured"
  double low = kNoValue, high = kNoValue;  ///< its interval, if known; may be infinite
  std::string note;
  std::int64_t cell = kNoCell;
};

/// Reference value: no effect, or the requirement.
struct IntervalReference {
  double value = 0.0;
  std::string label;
};

struct IntervalPlot {
  PlotTexts texts;
  Quantity value;
  std::string rows_title;         ///< kind of the rows: "setting"
  std::string spread_label;       ///< "95 % interval"
  std::vector<IntervalRow> rows;  ///< from top to bottom
  std::optional<IntervalReference> reference;
};

/// <figure>; "" without rows. A dot is hollow if its interval contains the reference.
std::string interval_plot(const IntervalPlot& plot);

}  // namespace vinerow::study
