#pragma once
/// What readers of files share.

#include <filesystem>
#include <optional>
#include <string>

namespace vinerow {

/// All bytes of a file. nullopt where it does not exist, is a folder or cannot be opened.
std::optional<std::string> read_bytes(const std::filesystem::path& file);

/// ".obj" of "a/House.OBJ", "" where there is none.
std::string lower_extension(const std::filesystem::path& file);

}  // namespace vinerow
