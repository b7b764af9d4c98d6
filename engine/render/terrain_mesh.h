#pragma once
/// Triangle meshes of the height field, in chunks that get coarser with distance, and of the
/// surrounding land.

#include <vector>

#include "engine/render/mesh_preparation.h"

namespace vinerow::render {

/// Cells along one side of a chunk.
constexpr int kChunkCells = 32;
/// Strides 1, 2, 4, 8, 16.
constexpr int kTerrainLevels = 5;

/// One chunk: (kChunkCells + 1)^2 vertices and a skirt that hides cracks between levels. At the far
/// edges of the field, samples are repeated, which gives degenerate triangles.
PreparedMesh make_terrain_chunk(const HeightField& field, int column, int row);

/// Indices for any chunk: the surface, split like HeightField's, and the skirt.
std::vector<std::uint32_t> make_chunk_indices(int level);

/// Level of detail of a chunk. @param seen_distance_m  see calc_seen_distance
int pick_terrain_level(double seen_distance_m, double cell_m);

/// Ground from the border of a rectangle to the horizon, in eight sectors. It starts at the
/// border's heights and rises to hills of about 100 m at 3 km.
/// @param border_height_m  height at a point of the border
std::vector<PreparedMesh> make_surroundings(const Eigen::AlignedBox2d& rectangle,
                                            const HeightField* field, double level_height_m);

}  // namespace vinerow::render
