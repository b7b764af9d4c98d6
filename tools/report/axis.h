#pragma once
/// One axis of a plot: what range it shows, its ticks, and where a value lies on the page.

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
  /// Values that are not finite are passed over.
  void include(double value);
  void include(std::span<const double> values);
  /// Wider by `share` of its span on either side, and not narrower than `least` in all.
  Range padded(double share, double least) const;
};

/// A tick's text with as many digits as its step has: 0.05 steps give "0.10". A true minus sign.
/// @param step  > 0, distance to the next tick
std::string tick_text(double value, double step);

/// The same as a power of ten: 1.5e7 in steps of 5e6 is "1.5·10⁷". Zero is "0".
/// @param step  > 0
std::string power_text(double value, double step);

/// Where values lie: equal differences, or equal ratios, equally far apart.
enum class AxisScale { kLinear, kLogarithmic };

class Axis {
 public:
  /// `range.low` lies at from_px, `range.high` at to_px (which is less for an axis that points up).
  /// @pre the range is not empty and its span is above 0; range.low > 0 where it is logarithmic
  Axis(const Range& range, double from_px, double to_px, int most_ticks,
       AxisScale scale = AxisScale::kLinear);

  /// @pre value > 0 where the axis is logarithmic
  double px(double value) const {
    if (scale_ == AxisScale::kLogarithmic) return logarithmic_px(value);
    return from_px_ + (value - range_.low) / range_.span() * (to_px_ - from_px_);
  }
  const Range& range() const { return range_; }
  double from_px() const { return from_px_; }
  double to_px() const { return to_px_; }
  /// Round numbers inside the range.
  const std::vector<double>& ticks() const { return ticks_; }
  std::string text(double tick) const { return tick_text(tick, step_); }
  /// As text(), but short where the range holds very large or very small numbers, and where the
  /// axis is logarithmic: "1.5·10⁷".
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
