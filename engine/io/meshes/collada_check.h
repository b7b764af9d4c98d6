#pragma once
/// Validation of COLLADA files before assimp reads them. assimp reserves memory for counts as
/// stated in the file, and follows recursive node instances endlessly.

#include <filesystem>

namespace vinerow::io {

/// @throws ConfigError naming the file: "... is broken: count = '1999999999' of <float_array> in
/// line 12, ...", "... the node 'n' contains itself"; not XML, with the line
void check_collada(const std::filesystem::path& file);

}  // namespace vinerow::io
