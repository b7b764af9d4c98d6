#pragma once
/// Traps of assimp 5.2 and how load_mesh steps round them.
///
/// 1. Debian's build has assertions on: some broken files would abort the process. assimp_traps.cpp
/// defines the function
///    that assimp calls then, so that it throws and ReadFile returns with an error text.
/// 2. Its reader of binary PLY walks past the end of a file that was cut off, and never returns
/// from a header without end.
/// 3. It swallows a line feed that is the first byte of the data (assimp issue 5341), one file in
/// 256, and reads
///    everything behind it shifted.

#include <filesystem>
#include <optional>
#include <string>

namespace vinerow::io {

/// Checks a binary PLY file and guards it where needed.
/// @returns the contents with one more leading property per vertex where trap 3 would strike; else
/// nullopt: the file
///          itself can be read. ASCII PLY is left to assimp.
/// @throws ConfigError "mesh file 'x.ply' is cut off: element face 12 of 96 is not whole"; a face's
/// index beyond the
///         vertices
std::optional<std::string> check_ply(const std::filesystem::path& file);

}  // namespace vinerow::io
