#pragma once
/// summary.json: everything a script wants to know of a run.

#include <filesystem>
#include <string>

#include "engine/run/run.h"
#include "engine/sim/simulation.h"

namespace vinerow::run {

/// @returns the JSON text. @param simulation  for costs and notes; its metrics are taken from
/// `result`
std::string summary_json(const RunResult& result, Simulation& simulation);

/// Version of this program, "0.1.0".
std::string program_version();

}  // namespace vinerow::run
