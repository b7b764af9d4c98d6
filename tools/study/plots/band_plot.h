#pragma once
/// A metric over a numeric factor: a line for each group, with its interval as band or whiskers.

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
  double low = kNoValue, high = kNoValue;  ///< its interval, where known
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
  /// A logarithmic axis leaves out what is not above 0.
  tools::report::AxisScale x_scale = tools::report::AxisScale::kLinear;
  tools::report::AxisScale y_scale = tools::report::AxisScale::kLinear;
};

/// <figure>; "" where no group has a point that can be drawn.
std::string band_plot(const BandPlot& plot);

}  // namespace vinerow::study
