#pragma once
/// Writer of summary.json: all results of a run, for scripts.

#include <filesystem>
#include <string>

#include "engine/run/run.h"
#include "engine/sim/simulation.h"

namespace vinerow::run {

/// @param simulation  for costs and notes; metrics are taken from `result`
/// @param profile  may be null
/// @returns the JSON text
std::string summary_json(const RunResult& result, Simulation& simulation,
                         const RunProfile* profile);

/// Version of this program, "0.1.0".
std::string program_version();

}  // namespace vinerow::run
