#pragma once
/// Summary of the simulated setup: the place, and each vehicle with its sensors.

#include <string>

#include "tools/report/run_folder.h"

namespace vinerow::tools::report {

/// Table for the first screen; "" if the scenario is unknown.
std::string setup_table(const RunFolder& run);

}  // namespace vinerow::tools::report
