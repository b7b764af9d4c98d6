#pragma once
/// Folders that output goes to.

#include <filesystem>

namespace vinerow::io {

/// Makes a folder and those above it where they are not there.
/// @throws ConfigError "folder '/proc/x' cannot be made: No such file or directory"
void make_folder(const std::filesystem::path& folder);

/// The same for the folder that a file is to stand in.
void make_folder_of(const std::filesystem::path& file);

}  // namespace vinerow::io
