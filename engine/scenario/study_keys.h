#pragma once
/// The keys of a study file: one table, read by the loader and by the JSON Schema.

#include <string>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/scenario/study.h"

namespace vinerow::scenario {

/// The version of the file format that this program reads (`vinerow_study: 1`).
constexpr std::int64_t kStudyVersion = 1;

struct StudyValues {
  std::int64_t format = kStudyVersion;
  Study study;
};
/// Keys whose values are parameters.
const ParameterTable<StudyValues>& study_table();

/// A key with a form of its own.
struct FreeStudyKey {
  std::string name;
  std::string description;
};
/// `set`, `factors`, `seeds`, `derived`.
const std::vector<FreeStudyKey>& free_study_keys();

}  // namespace vinerow::scenario
