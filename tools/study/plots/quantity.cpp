#include "tools/study/plots/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/html.h"

namespace vinerow::study {
namespace {

using tools::report::number_text;
using tools::report::Range;

std::string with_unit(const std::string& number, const std::string& unit) {
  if (unit.empty()) return number;
  return number + (unit == "°" ? "" : " ") + unit;
}

/// " (0.71 to 0.91)"; "" if the interval is unknown.
template <typename Text>
std::string in_brackets(double low, double high, const Text& text) {
  if (std::isnan(low) || std::isnan(high)) return "";
  const auto bound = [&](double at) {
    return std::isfinite(at) ? text(at) : std::string(at < 0.0 ? "−∞" : "∞");
  };
  return fmt::format(" ({} to {})", bound(low), bound(high));
}

}  // namespace

std::string Quantity::title() const {
  return unit.empty() ? label : label + ", " + unit;
}

bool can_draw(double value) {
  constexpr double kLargest = 1e300;
  return std::isfinite(value) && std::abs(value) <= kLargest;
}

Range axis_range(const Range& values, const Quantity& quantity, double share) {
  if (values.empty()) return {0.0, 1.0};
  const double size = std::max(std::abs(values.low), std::abs(values.high));
  // Differences within rounding count as zero.
  constexpr double kRounding = 1e-9, kMargin = 0.2, kSmallest = 1e-290;
  const bool equal = values.span() <= kRounding * size || values.span() < kSmallest;
  Range range = values.padded(share, 0.0);
  if (equal) range = values.padded(0.0, size < kSmallest ? 1.0 : kMargin * size);
  if (values.low >= quantity.minimum) range.low = std::max(range.low, quantity.minimum);
  if (values.high <= quantity.maximum) range.high = std::min(range.high, quantity.maximum);
  return range;
}

Range logarithmic_range(const Range& values) {
  if (values.empty()) return {1.0, 10.0};
  constexpr double kMinRatio = 1.5;
  const double ratio = std::max(std::pow(values.high / values.low, 0.04), 1.0);
  Range range = {values.low / ratio, values.high * ratio};
  if (range.high < kMinRatio * range.low) {
    range = {values.low / kMinRatio, values.high * kMinRatio};
  }
  return range;
}

std::string value_text(double value, const Quantity& quantity) {
  if (!std::isfinite(value)) return number_text(value);
  return with_unit(number_text(value), quantity.unit);
}

std::string interval_text(double value, double low, double high, const Quantity& quantity) {
  if (!std::isfinite(value)) return value_text(value, quantity);
  return with_unit(number_text(value) + in_brackets(low, high, number_text), quantity.unit);
}

std::string even_text(double value, const Range& range) {
  const double step = std::pow(10.0, std::round(std::log10(range.span())) - 2.0);
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  return size < 1e6 && step > 1e-6 ? tools::report::tick_text(value, std::min(step, 1.0))
                                   : tools::report::power_text(value, step);
}

std::string even_interval_text(double value, double low, double high, const Range& range) {
  if (!std::isfinite(value)) return number_text(value);
  const auto text = [&](double number) { return even_text(number, range); };
  return text(value) + in_brackets(low, high, text);
}

}  // namespace vinerow::study
