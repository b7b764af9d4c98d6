#pragma once
/// Profile of a command: recording, and its table and files.

#include <filesystem>
#include <string>

#include "engine/run/run_profile.h"

namespace vinerow::tools {

/// A profile with the clock and the heap counter of this program.
run::RunProfile make_profile();

/// The rows that took the most time, for a terminal.
std::string profile_table(const run::RunProfile& profile);

/// Writes profile.csv and profile.json. @throws WriteError
void write_profile(const run::RunProfile& profile, const std::filesystem::path& folder);

}  // namespace vinerow::tools
