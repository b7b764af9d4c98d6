#pragma once
/// report.html: all that a run tells, as one page that opens without a network.

#include <filesystem>

#include "engine/api/registry.h"

namespace vinerow::tools {

/// Writes the page. Its bytes follow from the run alone but for the section Timings at its end,
/// which the script repeats on the first screen.
/// @param run_folder  with summary.json; log.mcap, scenario.resolved.yaml, frames/*.png,
///   coverage*.png, products/*/*.png and canopy/*.json are shown where they are there
/// @param registry  with every part that the run's scenario names
/// @throws ConfigError where the folder is none of a run, its files are broken or of another run,
/// or the page cannot be written
void write_report(const std::filesystem::path& run_folder, const Registry& registry,
                  const std::filesystem::path& out_file);

}  // namespace vinerow::tools
