#pragma once
/// Axis of a plot: range, ticks, and mapping from values to pixels.

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace vinerow::tools::report {

/// A closed range of numbers; empty until something is included.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  bool empty() const { return !(high >= low); }
  double span() const { return empty() ? 0.0 : high - low; }
  /// Ignores values that are not finite.
  void include(double value);
  void include(std::span<const double> values);
  /// Range widened by `share` of its span on either side, and at least `min_span` wide in total.
  Range padded(double share, double min_span) const;
};

/// Tick label with as many decimals as its step: steps of 0.05 give "0.10". Uses the minus sign
/// U+2212.
/// @param step  > 0, distance to the next tick
std::string tick_text(double value, double step);

/// Tick label as a power of ten: 1.5e7 in steps of 5e6 is "1.5·10⁷". Zero is "0".
/// @param step  > 0
std::string power_text(double value, double step);

/// Scale of an axis: equal differences, or equal ratios, are equally far apart.
enum class AxisScale { kLinear, kLogarithmic };

class Axis {
 public:
  /// Maps `range.low` to from_px and `range.high` to to_px (to_px < from_px if the axis points up).
  /// @pre the range is not empty and its span is > 0; range.low > 0 if it is logarithmic
  Axis(const Range& range, double from_px, double to_px, int max_ticks,
       AxisScale scale = AxisScale::kLinear);

  /// @pre value > 0 if the axis is logarithmic
  double px(double value) const {
    if (scale_ == AxisScale::kLogarithmic) return logarithmic_px(value);
    return from_px_ + (value - range_.low) / range_.span() * (to_px_ - from_px_);
  }
  const Range& range() const { return range_; }
  double from_px() const { return from_px_; }
  double to_px() const { return to_px_; }
  /// Ticks: round numbers inside the range.
  const std::vector<double>& ticks() const { return ticks_; }
  std::string text(double tick) const { return tick_text(tick, step_); }
  /// As text(), but as a power of ten ("1.5·10⁷") if the range has very large or very small numbers
  /// or the axis is logarithmic.
  std::string short_text(double tick) const;

 private:
  double logarithmic_px(double value) const;

  Range range_;
  double from_px_, to_px_;
  AxisScale scale_;
  std::vector<double> ticks_;
  double step_ = 1.0;
};

}  // namespace vinerow::tools::report
