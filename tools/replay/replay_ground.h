#pragma once
/// Ground of a replay: meshes of the terrain and of the country around it.

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "engine/api/height_field.h"
#include "engine/render/mesh_preparation.h"

namespace vinerow::tools {

/// Range of cells of a field; the last of each direction is excluded.
struct CellRange {
  Eigen::Vector2i first = {0, 0};
  Eigen::Vector2i last = {0, 0};
};

/// Triangles of a height field as meshes of at most 65 535 vertices. Neighbouring meshes share
/// their border, and a curtain hangs below the outer edges. Cells are split as in HeightField.
/// @param hole  cells to leave out
std::vector<render::PreparedMesh> terrain_meshes(const HeightField& field,
                                                 const CellRange& hole = {});

/// Country around a field, as in the renderer, with a curtain below its border with the field.
std::vector<render::PreparedMesh> surroundings_meshes(const HeightField& field);

/// Terrain with about `max_samples`: fine around the focus and coarse elsewhere.
struct ReplayTerrain {
  HeightField coarse;
  CellRange hole;  ///< cells of the coarse field that the fine one covers
  std::optional<HeightField>
      fine;  ///< absent if the coarse one has all samples or there is no focus
};

/// @param focus_W  area in which vehicles work; may be empty
ReplayTerrain thin_terrain(const HeightField& field, const Eigen::AlignedBox2d& focus_W,
                           int max_samples);

}  // namespace vinerow::tools
