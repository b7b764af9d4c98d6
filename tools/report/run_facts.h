#pragma once
/// What a run was made of, and what it cost.

#include <string>

#include "tools/report/run_folder.h"

namespace vinerow::tools::report {

/// Digest, seed, versions, notes, what planners counted, the resolved scenario.
std::string facts(const RunFolder& run);

/// Wall-clock times; all that depends on the machine. The real-time factor has the id
/// "real-time-factor".
std::string timings(const RunFolder& run);

}  // namespace vinerow::tools::report
