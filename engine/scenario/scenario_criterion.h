#pragma once
/// Reader of the criteria of a run or a phase.

#include <string>
#include <vector>

#include "engine/scenario/scenario.h"
#include "engine/scenario/scenario_reader.h"

namespace vinerow::scenario {

/// Metrics that criteria may name.
struct CriterionScope {
  std::vector<std::string> owners;  ///< vehicles, and jobs of a mission: "<owner>.<metric>"
  bool plain = false;               ///< a job's own numbers: "<number>"
};

/// Reads a list of criteria. @param entry  nullptr: no criteria. @param written  receives the
/// resolved list
std::vector<Criterion> read_criteria(const io::YamlEntry* entry, const std::string& path,
                                     const CriterionScope& scope, io::YamlNode& written);

}  // namespace vinerow::scenario
