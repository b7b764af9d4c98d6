#pragma once
/// The ground of a replay: terrain as meshes, and the country around it.

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "engine/api/height_field.h"
#include "engine/render/mesh_preparation.h"

namespace vinerow::tools {

/// Cells of a field: from the first to before the last of each direction.
struct CellRange {
  Eigen::Vector2i first = {0, 0};
  Eigen::Vector2i last = {0, 0};
};

/// The triangles of a height field as meshes of at most 65 535 vertices, neighbours sharing their
/// border; a curtain hangs below its outer edges. Split as HeightField splits its cells.
/// @param hole  cells that are left out
std::vector<render::PreparedMesh> terrain_meshes(const HeightField& field,
                                                 const CellRange& hole = {});

/// The country around a field, as the renderer has it, with a curtain below where it meets it.
std::vector<render::PreparedMesh> surroundings_meshes(const HeightField& field);

/// A field drawn by about `most_samples`: fine around what matters and coarse elsewhere.
struct ReplayTerrain {
  HeightField coarse;
  CellRange hole;                   ///< of the coarse field, where the fine one lies
  std::optional<HeightField> fine;  ///< absent where the coarse one has all samples, or no focus
};

/// @param focus_W  where vehicles work; may be empty
ReplayTerrain thin_terrain(const HeightField& field, const Eigen::AlignedBox2d& focus_W,
                           int most_samples);

}  // namespace vinerow::tools
