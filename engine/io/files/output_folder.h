#pragma once
/// Creation of output folders.

#include <filesystem>

namespace vinerow::io {

/// Creates a folder and its missing parents.
/// @throws ConfigError "folder '/proc/x' cannot be created: No such file or directory"
void make_folder(const std::filesystem::path& folder);

/// The same for the parent folder of a file.
void make_folder_of(const std::filesystem::path& file);

}  // namespace vinerow::io
