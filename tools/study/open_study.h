#pragma once
/// Opened study with its scenario, plug-ins and design.

#include <filesystem>
#include <memory>

#include "engine/api/registry.h"
#include "engine/scenario/study.h"
#include "tools/study/design.h"
#include "tools/study/identity.h"

namespace vinerow::study {

struct OpenStudy {
  /// Reads the study and its scenario, loads plug-ins. @throws ConfigError
  explicit OpenStudy(const std::filesystem::path& file);
  OpenStudy(const OpenStudy&) = delete;
  OpenStudy& operator=(const OpenStudy&) = delete;

  const scenario::Study study;
  const Design design;
  const scenario::ScenarioSource source;
  Registry registry;
  const Identity identity;
};

/// Checks a study before the first cell: key paths and values that do not fit the scenario, names
/// of metrics that no cell has, expressions that cannot be computed.
/// @throws ConfigError
void check_study(const OpenStudy& open);

}  // namespace vinerow::study
