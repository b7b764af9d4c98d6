#pragma once
/// Two traps of assimp 5.2 and how load_mesh steps round them.
///
/// 1. Debian's build has assertions on: some broken files would abort the process. assimp_traps.cpp
/// defines the function
///    that assimp calls then, so that it throws and ReadFile returns with an error text.
/// 2. Its reader of binary PLY swallows a line feed that is the first byte of the data (assimp
/// issue 5341), one file in
///    256, and reads everything behind it shifted. A byte put before each vertex keeps it in step.

#include <filesystem>
#include <optional>
#include <string>

namespace vinerow::io {

/// The contents of a binary PLY file with one more leading property, `guard`, per vertex.
/// @returns nullopt where the file needs no guard: ASCII, no PLY, or a first byte that assimp does
/// not mistake
std::optional<std::string> read_guarded_ply(const std::filesystem::path& file);

}  // namespace vinerow::io
