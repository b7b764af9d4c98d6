#pragma once
/// Quantity on an axis or colour scale: name, unit and possible values.

#include <limits>
#include <span>
#include <string>

#include "tools/report/axis.h"

namespace vinerow::study {

/// Missing value.
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

struct Quantity {
  std::string label;
  std::string unit;  ///< "m/s"; empty without a unit
  /// Possible values, which limit an axis: 0 to 1 for a probability.
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();

  /// "row speed, m/s".
  std::string title() const;
};

/// Whether a plot can show a value: it is finite and small enough for finite differences.
bool can_draw(double value);

/// Range of an axis: the values' range widened by `share` of its span on either side, within the
/// possible values. Equal values get a margin; without values it is 0 to 1.
tools::report::Range axis_range(const tools::report::Range& values, const Quantity& quantity,
                                double share = 0.05);

/// The same for a logarithmic axis, by ratio. @pre values.low > 0 if there are values
tools::report::Range logarithmic_range(const tools::report::Range& values);

/// "0.83 m/s"; "not measured" if it is not finite.
std::string value_text(double value, const Quantity& quantity);

/// "0.83 (0.71 to 0.91) m/s"; as value_text() if the interval is unknown.
std::string interval_text(double value, double low, double high, const Quantity& quantity);

/// Value with enough digits to resolve about a hundredth of a range. All values of a plot get
/// equally many digits, which makes them easy to compare. @pre range.span() > 0
std::string even_text(double value, const tools::report::Range& range);

/// "0.83 (0.71 to 0.91)" with the same digits.
std::string even_interval_text(double value, double low, double high,
                               const tools::report::Range& range);

}  // namespace vinerow::study
