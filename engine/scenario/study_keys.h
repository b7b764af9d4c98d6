#pragma once
/// Table of the keys of a study file, used by the loader and the JSON Schema.

#include <string>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/scenario/study.h"

namespace vinerow::scenario {

/// Version of the file format (`vinerow_study: 1`).
constexpr std::int64_t kStudyVersion = 1;

struct StudyValues {
  std::int64_t format = kStudyVersion;
  Study study;
};
/// Keys whose values are parameters.
const ParameterTable<StudyValues>& study_table();

/// Key whose value is not a parameter.
struct FreeStudyKey {
  std::string name;
  std::string description;
};
/// The keys `set`, `factors`, `seeds` and `derived`.
const std::vector<FreeStudyKey>& free_study_keys();

}  // namespace vinerow::scenario
