#include "tools/vinerow/report/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/vinerow/colour_scale.h"

namespace vinerow::tools::report {

void Range::include(double value) {
  if (!std::isfinite(value)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

void Range::include(std::span<const double> values) {
  for (const double value : values) include(value);
}

Range Range::padded(double share, double least) const {
  if (empty()) return {-0.5 * least, 0.5 * least};
  const double more = std::max(share * span(), 0.5 * (least - span()));
  return {low - more, high + more};
}

std::string tick_text(double value, double step) {
  // A step of 1, 2 or 5 times a power of ten needs no digit behind its first.
  const int digits = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::string text = fmt::format("{:.{}f}", std::abs(value), digits);
  const bool is_zero = text.find_first_not_of("0.") == std::string::npos;
  return value < 0.0 && !is_zero ? "−" + text : text;
}

Axis::Axis(const Range& range, double from_px, double to_px, int most_ticks)
    : range_(range),
      from_px_(from_px),
      to_px_(to_px),
      ticks_(tools::ticks(range.low, range.high, most_ticks)) {
  // One tick alone says nothing of a step: it gets the digits of the range.
  step_ = ticks_.size() > 1 ? ticks_[1] - ticks_[0]
                            : std::pow(10.0, std::floor(std::log10(range.span())) - 1.0);
}

}  // namespace vinerow::tools::report
