#pragma once
/// report.html: all that a run tells, as one page that opens without a network.

#include <filesystem>
#include <functional>

#include "engine/api/registry.h"

namespace vinerow::tools {

/// Writes the page. Its bytes follow from the run alone but for the section Timings at its end,
/// which the script repeats on the first screen.
/// Whole or not at all: where it throws, a page of before is still there.
/// @param run_folder  with summary.json; log.mcap, scenario.resolved.yaml, frames/*.png,
///   coverage*.png, products/*/*.png and canopy/*.json are shown where they are there
/// @param registry  with every part that the run's scenario names
/// @param progress  told between the steps of the work; what it throws ends that
/// @throws ConfigError where the folder is none of a run, its files are broken or of another run;
/// as WholeFile (engine/core/whole_file.h) where the page cannot be written
void write_report(const std::filesystem::path& run_folder, const Registry& registry,
                  const std::filesystem::path& out_file,
                  const std::function<void(int done, int total)>& progress = {});

}  // namespace vinerow::tools
