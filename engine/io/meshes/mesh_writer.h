#pragma once
/// Lossless files of triangle meshes as binary PLY: load_mesh(join_vertices = false) reads back an
/// equal mesh, and read_intact_ply() does so quickly.

#include <filesystem>
#include <optional>

#include "engine/api/mesh.h"

namespace vinerow::io {

/// Writes little-endian PLY 1.0: vertices as float x y z, with nx ny nz, s t and red green blue if
/// the mesh has them (one entry per vertex or none), faces as uchar 3 + 3 int, and the mesh's
/// things as an element of its own, which other readers skip. Colours stay linear, which load_mesh
/// assumes for PLY colours that are not bytes. A comment holds the digest of the rest of the file.
/// @throws ConfigError naming the file if it cannot be written completely
void write_ply(const TriangleMesh& mesh, const std::filesystem::path& file);

/// The mesh of an unmodified file of write_ply(), equal to the bit, many times faster than by
/// load_mesh(). @returns nothing for any other file
std::optional<TriangleMesh> read_intact_ply(const std::filesystem::path& file);

}  // namespace vinerow::io
