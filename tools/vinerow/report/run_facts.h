#pragma once
/// What a run was made of, and what it cost.

#include <string>

#include "tools/vinerow/report/run_folder.h"

namespace vinerow::tools::report {

/// "Vineyard quadrotor two rows" of "vineyard_quadrotor_two_rows".
std::string title_of(const std::string& scenario);

/// Digest, seed, versions, notes, what planners counted, the resolved scenario.
std::string facts(const RunFolder& run);

/// Wall-clock times; all that depends on the machine. The real-time factor has the id
/// "real-time-factor".
std::string timings(const RunFolder& run);

}  // namespace vinerow::tools::report
