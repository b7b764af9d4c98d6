#pragma once
/// Reads the limits that a run, or a phase of it, must meet.

#include <string>
#include <vector>

#include "engine/scenario/scenario.h"
#include "engine/scenario/scenario_reader.h"

namespace vinerow::scenario {

/// Whose metrics criteria may name.
struct CriterionScope {
  std::vector<std::string> owners;  ///< vehicles, and jobs of a mission: "<owner>.<metric>"
  bool plain = false;               ///< a job's own numbers: "<number>"
};

/// A list of criteria. @param entry  nullptr: none. @param written  the resolved list
std::vector<Criterion> read_criteria(const io::YamlEntry* entry, const std::string& path,
                                     const CriterionScope& scope, io::YamlNode& written);

}  // namespace vinerow::scenario
