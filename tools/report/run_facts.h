#pragma once
/// Facts about a run: its ingredients and its computing cost.

#include <string>

#include "tools/report/run_folder.h"

namespace vinerow::tools::report {

/// Digest, seed, versions, notes, planner statistics, the resolved scenario.
std::string facts(const RunFolder& run);

/// Wall-clock times, the only content that depends on the machine. The real-time factor has the id
/// "real-time-factor".
std::string timings(const RunFolder& run);

}  // namespace vinerow::tools::report
