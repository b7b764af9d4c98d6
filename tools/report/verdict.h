#pragma once
/// Verdict of a run in one plain sentence, and the table of its criteria.

#include <string>

#include "tools/report/run_folder.h"

namespace vinerow::tools::report {

struct Verdict {
  enum class Kind { kMet, kFailed, kBrokenOff, kOpen };
  Kind kind = Kind::kOpen;
  std::string headline;  ///< "All 7 requirements met"
  std::string sentence;  ///< the failures, or the success
  std::string remark;    ///< further explanation, or ""
};

Verdict make_verdict(const RunFolder& run);

/// Verdict box of the first screen.
std::string verdict_box(const Verdict& verdict);

/// Every criterion of the run and of its phases, with value, limit and definition of the metric.
std::string criteria_table(const RunFolder& run);

/// Table of all metrics of all vehicles.
std::string metrics_table(const RunFolder& run);

/// Title of a metric: "rover: largest wheel slip" for "rover.slip_max".
std::string criterion_title(const std::string& metric);

}  // namespace vinerow::tools::report
