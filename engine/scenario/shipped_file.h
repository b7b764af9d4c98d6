#pragma once
/// Scenarios, studies and vehicles that are installed with the program.

#include <filesystem>

namespace vinerow::scenario {

/// Installed file for a path `assets/...` that does not exist in the current folder, so that the
/// examples of help texts and documentation work everywhere. It is searched in `share/vinerow`
/// beside the library's file and up to two folders above it: lib/libvinerow.so of a prefix,
/// /usr/lib, or the folder of the Python package.
/// @returns the path itself if it exists, is another path, or has no installed file
std::filesystem::path find_shipped(const std::filesystem::path& file);

}  // namespace vinerow::scenario
