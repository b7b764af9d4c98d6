#pragma once
/// Helpers for file readers.

#include <filesystem>
#include <optional>
#include <string>

namespace vinerow {

/// All bytes of a file; nullopt if it does not exist, is a folder or cannot be opened.
std::optional<std::string> read_bytes(const std::filesystem::path& file);

/// Lower-case extension: ".obj" of "a/House.OBJ", "" if there is no extension.
std::string lower_extension(const std::filesystem::path& file);

}  // namespace vinerow
