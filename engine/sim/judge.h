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

/// "rover.a_m = 0.5 (at most 0.4)", "rover.a_m was not measured (at most 0.4)".
std::string sentence_of(const CriterionResult& criterion);

}  // namespace vinerow
