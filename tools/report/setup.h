#pragma once
/// What was simulated, in a few lines: the place, and each vehicle with its sensors.

#include <string>

#include "tools/report/run_folder.h"

namespace vinerow::tools::report {

/// A table for the first screen; "" where the scenario is not known.
std::string setup_table(const RunFolder& run);

}  // namespace vinerow::tools::report
