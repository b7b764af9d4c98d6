#include "tools/report/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <initializer_list>

#include "tools/pictures/colour_scale.h"

namespace vinerow::tools::report {
namespace {

/// A logarithmic axis with a smaller ratio of its ends has linear ticks. Chosen.
constexpr double kMinRatio = 5.0;

std::string raised(int exponent) {
  constexpr std::array<const char*, 10> kDigits = {"⁰", "¹", "²", "³", "⁴",
                                                   "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

/// Multiples of every `stride`-th power of ten.
std::vector<double> ticks_of_powers(const Range& range, std::initializer_list<int> multiples,
                                    int stride) {
  std::vector<double> ticks;
  const int first = static_cast<int>(std::floor(std::log10(range.low))) - 1;
  const int last = static_cast<int>(std::ceil(std::log10(range.high))) + 1;
  for (int power = first; power <= last; ++power) {
    if (power % stride != 0) continue;
    for (const int multiple : multiples) {
      const double tick = multiple * std::pow(10.0, power);
      const bool inside = tick >= range.low * (1.0 - 1e-9) && tick <= range.high * (1.0 + 1e-9);
      if (inside && std::isfinite(tick)) ticks.push_back(tick);
    }
  }
  return ticks;
}

std::vector<double> logarithmic_ticks(const Range& range, int max_ticks) {
  if (range.high < kMinRatio * range.low) return tools::ticks(range.low, range.high, max_ticks);
  const auto fits = [&](const std::vector<double>& ticks) {
    return static_cast<int>(ticks.size()) <= max_ticks;
  };
  std::vector<double> ticks = ticks_of_powers(range, {1, 2, 5}, 1);
  for (int stride = 1; !fits(ticks) && stride < 1000; ++stride) {
    ticks = ticks_of_powers(range, {1}, stride);
  }
  return ticks;
}

}  // namespace

void Range::include(double value) {
  if (!std::isfinite(value)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

void Range::include(std::span<const double> values) {
  for (const double value : values) include(value);
}

Range Range::padded(double share, double min_span) const {
  if (empty()) return {-0.5 * min_span, 0.5 * min_span};
  const double more = std::max(share * span(), 0.5 * (min_span - span()));
  return {low - more, high + more};
}

std::string tick_text(double value, double step) {
  // A step of 1, 2 or 5 times a power of ten has one significant digit.
  const int digits = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::string text = fmt::format("{:.{}f}", std::abs(value), digits);
  const bool is_zero = text.find_first_not_of("0.") == std::string::npos;
  return value < 0.0 && !is_zero ? "−" + text : text;
}

std::string power_text(double value, double step) {
  if (value == 0.0) return "0";
  const double size = std::abs(value);
  const double powers = std::floor(std::log10(size) + 1e-9) - std::floor(std::log10(step) + 1e-9);
  const std::string text =
      fmt::format("{:.{}e}", size, static_cast<int>(std::clamp(powers, 0.0, 15.0)));
  const std::size_t e = text.find('e');
  const std::string mantissa = text.substr(0, e), power = raised(std::stoi(text.substr(e + 1)));
  return (value < 0.0 ? "−" : "") + (mantissa == "1" ? "" : mantissa + "·") + "10" + power;
}

Axis::Axis(const Range& range, double from_px, double to_px, int max_ticks, AxisScale scale)
    : range_(range),
      from_px_(from_px),
      to_px_(to_px),
      scale_(scale),
      ticks_(scale == AxisScale::kLinear ? tools::ticks(range.low, range.high, max_ticks)
                                         : logarithmic_ticks(range, max_ticks)) {
  // A single tick has no step: its digits follow the range.
  step_ = ticks_.size() > 1 ? ticks_[1] - ticks_[0]
                            : std::pow(10.0, std::floor(std::log10(range.span())) - 1.0);
}

std::string Axis::short_text(double tick) const {
  constexpr double kLargest = 1e7, kSmallest = 1e-4;
  if (scale_ == AxisScale::kLogarithmic && range_.high >= kMinRatio * range_.low) {
    const bool plain = range_.low >= kSmallest && range_.high < kLargest;
    return plain ? fmt::format("{:.10g}", tick) : power_text(tick, tick);
  }
  const double largest = std::max(std::abs(range_.low), std::abs(range_.high));
  if (step_ >= kSmallest && largest < kLargest) return text(tick);
  // A tick at zero has a rounding error.
  return power_text(std::abs(tick) < 1e-6 * step_ ? 0.0 : tick, step_);
}

double Axis::logarithmic_px(double value) const {
  return from_px_ +
         std::log(value / range_.low) / std::log(range_.high / range_.low) * (to_px_ - from_px_);
}

}  // namespace vinerow::tools::report
