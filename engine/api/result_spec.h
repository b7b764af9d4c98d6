#pragma once
/// Declaration of a number that a metric, payload or job produces.
///
/// `vinerow list`, docs/reference/metrics.md, the report and the check of criteria before a run
/// (engine/sim/judge.h) read these declarations. A value that was not measured is NaN and outside
/// every range.

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace vinerow {

/// Values that a result can have.
struct ResultRange {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool whole = false;  ///< only whole numbers

  /// Either sign.
  static ResultRange any() { return {}; }
  /// Lengths, speeds, sizes of errors.
  static ResultRange from_zero() { return zero_to(std::numeric_limits<double>::infinity()); }
  static ResultRange zero_to(double highest) { return {0.0, highest, false}; }
  static ResultRange share() { return zero_to(1.0); }
  static ResultRange count() { return {0.0, std::numeric_limits<double>::infinity(), true}; }
  static ResultRange zero_or_one() { return {0.0, 1.0, true}; }

  /// Whether a value in [min, max] is possible.
  bool can_be_in(double min, double max) const;
  /// "0 or 1", "0 to 1", "whole numbers from 0", "from 0"; empty if every value is possible.
  std::string text() const;
};

struct ResultSpec {
  /// Key of results(). "<wheel>" stands for any name of one or more letters: "slip_max_<wheel>".
  std::string name;
  std::string unit;  ///< "m", "1/m"; "1" for counts and shares
  ResultRange range;
  std::string title;       ///< two to six words, for tables and reports
  std::string definition;  ///< one or two sentences
  std::string source;      ///< "paper B, eq. 8"; empty if the definition is ours
};

/// @returns the first declaration that fits the name, or nullptr
const ResultSpec* find_result(const std::vector<ResultSpec>& results, std::string_view name);

}  // namespace vinerow
