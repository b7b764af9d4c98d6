#pragma once
/// Verdicts on metrics.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/scenario/scenario.h"
#include "engine/sim/phase_report.h"

namespace vinerow {

/// @param metrics  [owner][metric]; metrics of the owner "" are named without an owner
/// @throws ConfigError naming the nearest metric if a criterion's metric does not exist
std::vector<CriterionResult> judge(
    const std::vector<scenario::Criterion>& criteria,
    const std::map<std::string, std::map<std::string, double>>& metrics);

/// Checks criteria before a run.
/// @param metrics  as above; the values are ignored
/// @param declared  returns the declaration for a metric's full name; nullptr if any value is
///   possible
/// @throws ConfigError if a metric does not exist, or none of its possible values meets a limit
void check_criteria(const std::vector<scenario::Criterion>& criteria,
                    const std::map<std::string, std::map<std::string, double>>& metrics,
                    const std::function<const ResultSpec*(const std::string&)>& declared);

/// Declaration of a metric of a vehicle, "rover.finished", or of a payload,
/// "rover.sprayer_litres_left"; nullptr if no part of the scenario declares it.
const ResultSpec* find_declared_result(const scenario::Scenario& scenario, const Registry& registry,
                                       const std::string& metric);

/// "rover.cross_track_rms_m = 0.0123 (at most 0.5)"; if the value is NaN,
/// "rover.cross_track_rms_m not measured (at most 0.5): it never drove a leg".
std::string sentence_of(const CriterionResult& criterion);

}  // namespace vinerow
