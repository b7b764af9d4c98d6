#pragma once
/// What an axis or a colour shows: its name, its unit and the values that are possible.

#include <limits>
#include <span>
#include <string>

#include "tools/report/axis.h"

namespace vinerow::study {

/// A value that is not there.
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

struct Quantity {
  std::string label;
  std::string unit;  ///< "m/s"; empty where it has none
  /// Possible values. An axis shows no room beyond them: 0 to 1 for a probability.
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();

  /// "row speed, m/s".
  std::string title() const;
};

/// Whether a plot can show a value: it is finite, and differences of such values are too.
bool can_draw(double value);

/// What an axis shows of values: wider by `share` of their span on either side, within what is
/// possible. Values that all are equal get room around them; no values at all give 0 to 1.
tools::report::Range axis_range(const tools::report::Range& values, const Quantity& quantity,
                                double share = 0.05);

/// The same for a logarithmic axis, by ratio. @pre values.low > 0 where there are any
tools::report::Range logarithmic_range(const tools::report::Range& values);

/// "0.83 m/s"; "not measured" of what is not finite.
std::string value_text(double value, const Quantity& quantity);

/// "0.83 (0.71 to 0.91) m/s"; as value_text() where the interval is not known.
std::string interval_text(double value, double low, double high, const Quantity& quantity);

/// The value with enough digits to tell about a hundredth of a range: all values of a plot get as
/// many, so that they are easy to compare. @pre range.span() > 0
std::string even_text(double value, const tools::report::Range& range);

/// "0.83 (0.71 to 0.91)" in such digits.
std::string even_interval_text(double value, double low, double high,
                               const tools::report::Range& range);

}  // namespace vinerow::study
