#pragma once
/// What COLLADA files claim about themselves, checked before assimp believes it: its reader
/// reserves memory for counts as they are written and follows instances of nodes without end.

#include <filesystem>

namespace vinerow::io {

/// @throws ConfigError naming the file: "... is broken: count = '1999999999' of <float_array> in
/// line 12, ...", "... the node 'n' contains itself"; no XML, with the line
void check_collada(const std::filesystem::path& file);

}  // namespace vinerow::io
