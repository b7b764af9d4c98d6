#pragma once
/// Verdicts on metrics.

#include <map>
#include <string>
#include <vector>

#include "engine/scenario/scenario.h"
#include "engine/sim/phase_report.h"

namespace vinerow {

/// @param metrics  [owner][metric]; those of the owner "" are named without one
/// @throws ConfigError naming the nearest metric if a criterion's metric does not exist
std::vector<CriterionResult> judge(
    const std::vector<scenario::Criterion>& criteria,
    const std::map<std::string, std::map<std::string, double>>& metrics);

/// Refuses before a run what can be known to be wrong with its criteria.
/// @param metrics  as above, whatever the values
/// @param parts    the scenario's metrics
/// @throws ConfigError if a metric does not exist, or no value that it can have meets a limit
void check_criteria(const std::vector<scenario::Criterion>& criteria,
                    const std::map<std::string, std::map<std::string, double>>& metrics,
                    const std::vector<scenario::NamedPart>& parts);

/// "rover.cross_track_rms_m = 0.0123 (at most 0.5)"; of a value that is NaN
/// "rover.cross_track_rms_m not measured (at most 0.5): it never drove a leg".
std::string sentence_of(const CriterionResult& criterion);

}  // namespace vinerow
