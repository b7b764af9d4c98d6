#pragma once
/// Plot of a metric over a numeric factor: one line per group, with intervals as band or whiskers.

#include <cstdint>
#include <string>
#include <vector>

#include "tools/study/plots/frame.h"
#include "tools/study/plots/marks.h"
#include "tools/study/plots/quantity.h"

namespace vinerow::study {

struct BandPoint {
  double x = 0.0;
  double value = kNoValue;                 ///< NaN: the line has a gap
  double low = kNoValue, high = kNoValue;  ///< its interval, if known
  std::string note;
  std::int64_t cell = kNoCell;
};

struct BandGroup {
  std::string label;
  std::vector<BandPoint> points;  ///< in any order of x
};

enum class Spread { kBand, kWhiskers };

struct BandPlot {
  PlotTexts texts;
  Quantity x, y;
  std::string spread_label;  ///< "95 % interval"
  std::vector<BandGroup> groups;
  Spread spread = Spread::kBand;
  /// A logarithmic axis leaves out values that are not above 0.
  tools::report::AxisScale x_scale = tools::report::AxisScale::kLinear;
  tools::report::AxisScale y_scale = tools::report::AxisScale::kLinear;
};

/// <figure>; "" if no group has a point that can be drawn.
std::string band_plot(const BandPlot& plot);

}  // namespace vinerow::study
