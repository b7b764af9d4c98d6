#pragma once
/// Report of a run: report.html, a single page that opens without a network.

#include <filesystem>
#include <functional>

#include "engine/api/registry.h"

namespace vinerow {
class RunShelf;
}

namespace vinerow::tools {

/// Writes the page. Its bytes depend on the run alone, except for the section Timings at its end,
/// from which the script copies to the first screen.
/// The file is written completely or not at all: if it throws, an earlier page stays.
/// @param run_folder  contains summary.json; log.mcap, scenario.resolved.yaml, frames/*.png,
///   coverage*.png, products/*/*.png and canopy/*.json are shown if they exist
/// @param registry  has every part that the run's scenario names
/// @param shelf  has the world, if the run has just ended
/// @param progress  called between the steps; an exception from it ends the work
/// @throws ConfigError if the folder is not that of a run, or its files are broken or belong to
/// another run; as WholeFile (engine/core/whole_file.h) if the page cannot be written
void write_report(const std::filesystem::path& run_folder, const Registry& registry,
                  const std::filesystem::path& out_file,
                  const std::function<void(int done, int total)>& progress = {},
                  RunShelf* shelf = nullptr);

}  // namespace vinerow::tools
