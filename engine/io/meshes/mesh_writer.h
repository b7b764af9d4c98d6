#pragma once
/// Writes triangle meshes as binary PLY, every bit kept: what load_mesh(join_vertices = false)
/// reads back is equal.

#include <filesystem>
#include <string>

#include "engine/api/forward.h"

namespace vinerow::io {

/// Little-endian PLY 1.0: vertices as float x y z, with nx ny nz, s t and red green blue where the
/// mesh has them (one entry per vertex or none), faces as uchar 3 + 3 int. Colours stay linear,
/// which load_mesh assumes of PLY colours that are not bytes. A comment holds the digest of the
/// rest of the file.
/// @throws ConfigError naming the file where it cannot be written completely
void write_ply(const TriangleMesh& mesh, const std::filesystem::path& file);

/// True for a file of write_ply with every byte as it was written.
bool is_intact_ply(const std::filesystem::path& file);

}  // namespace vinerow::io
