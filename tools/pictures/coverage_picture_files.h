#pragma once
/// Coverage picture files, for `vinerow coverage` and for runs.

#include <filesystem>
#include <vector>

#include "engine/playback/coverage_log.h"

namespace vinerow::tools {

/// Draws the coverage of every camera that took pictures in a run, and writes its numbers as .json.
/// @param out  the picture; with several cameras the camera's name is added
/// @returns the pictures; empty if the log has no shots
std::vector<std::filesystem::path> write_coverage(const std::filesystem::path& log,
                                                  const Registry& registry,
                                                  const playback::CoverageChoice& choice,
                                                  const std::filesystem::path& out);

}  // namespace vinerow::tools
