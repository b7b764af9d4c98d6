#pragma once
/// What became of a run, in a sentence that a stranger understands, and its table of criteria.

#include <string>

#include "tools/report/run_folder.h"

namespace vinerow::tools::report {

struct Verdict {
  enum class Kind { kMet, kFailed, kBrokenOff, kOpen };
  Kind kind = Kind::kOpen;
  std::string headline;  ///< "All 7 requirements met"
  std::string sentence;  ///< what failed, or what was done
  std::string remark;    ///< what a reader may ask next, or ""
};

Verdict make_verdict(const RunFolder& run);

/// The large box of the first screen.
std::string verdict_box(const Verdict& verdict);

/// Every criterion, of the run and of its phases, with value, limit, and what the metric means.
std::string criteria_table(const RunFolder& run);

/// All metrics of all vehicles.
std::string metrics_table(const RunFolder& run);

/// "rover: largest wheel slip" of "rover.slip_max".
std::string criterion_title(const std::string& metric);

}  // namespace vinerow::tools::report
