#pragma once
/// Verdicts on metrics.

#include <map>
#include <string>
#include <vector>

#include "engine/io/scenario.h"
#include "engine/sim/phase_report.h"

namespace vinerow {

/// @param metrics  [owner][metric]; those of the owner "" are named without one
/// @throws ConfigError naming the nearest metric if a criterion's metric does not exist
std::vector<CriterionResult> judge(
    const std::vector<io::Criterion>& criteria,
    const std::map<std::string, std::map<std::string, double>>& metrics);

}  // namespace vinerow
