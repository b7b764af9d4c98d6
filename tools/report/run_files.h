#pragma once
/// Files of a run beside those of engine/run: coverage, pictures of maps, report.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/run/run.h"

namespace vinerow::tools {

struct FurtherFiles {
  std::filesystem::path out;  ///< folder of the run
  bool coverage_and_maps = true;
  bool report = true;
  std::shared_ptr<RunShelf> shelf;  ///< of the run, with its world; may be null
  /// Called when files of a kind are written: "coverage", "map", "report".
  std::function<void(const char* kind, const std::vector<std::filesystem::path>&)> written;
  /// Called if files cannot be made. @param not_stored  true: the disk is full or fails
  std::function<void(const std::string& sentence, bool not_stored)> missing;
  /// Called between the steps of the report; an exception from it ends the work.
  std::function<void(int done, int total)> report_progress;
};

/// Writes what `vinerow run` adds to run_scenario(). Files that cannot be made change no verdict.
void write_further_files(const scenario::Scenario& scenario, const Registry& registry,
                         const run::RunResult& result, const FurtherFiles& wanted);

}  // namespace vinerow::tools
