#pragma once
/// The numbers that a metric gives: each declared once, by its name and the values it can have.
///
/// From here come what `vinerow list` says that the metric writes, and which limits of criteria no
/// run can meet (judge.h). A value that was not measured is NaN and lies in no range.

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace vinerow::metrics {

struct MetricNumber {
  /// As in results(); "<wheel>" stands for one name or another: "slip_max_<wheel>".
  std::string name;
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool whole = false;  ///< counts, and what is 0 or 1

  bool can_be_in(double min, double max) const;
  /// "0 or 1", "0 to 1", "whole numbers from 0", "from 0"; empty where every value is possible.
  std::string range_text() const;
};

/// Whose values may have either sign.
MetricNumber signed_number(std::string name);
/// Lengths, speeds, errors by size.
MetricNumber from_zero(std::string name);
MetricNumber zero_to(double highest, std::string name);
MetricNumber share_number(std::string name);
MetricNumber count_number(std::string name);
/// 0 or 1.
MetricNumber flag_number(std::string name);

/// For PartSpec::writes: "min_clearance_m: from 0".
std::vector<std::string> written(const std::vector<MetricNumber>& numbers);

/// The one that declares a result of this name; nullptr: none does.
const MetricNumber* find_number(const std::vector<MetricNumber>& numbers, std::string_view name);

}  // namespace vinerow::metrics
