#pragma once
/// Meshes of the scenery's rows and trees, cheap enough for thousands in the distance.

#include <memory>

#include "engine/api/scenery.h"
#include "engine/render/mesh_preparation.h"

namespace vinerow::render {

/// All rows of a field as strips in W: a ridge with two sides along the row. uv: metres along the
/// row; -1 and 1 at the feet, 0 at the top. Colour: of the leaves; a: a number of the row. Rows are
/// at integer multiples of the pitch from the field's first corner, as in LandUse.
PreparedMesh make_hedges(const SceneryField& field, const HeightField& terrain);

/// Vertical strip below each of these rows, from the ground into the leaves, on which the shader
/// draws stems. uv: metres along the row, 0. Normal: across the row. Colour a: as of the row.
PreparedMesh make_stems(const SceneryField& field, const HeightField& terrain);

/// Height of a tree's lowest leaves.
double scenery_crown_base_m(const SceneryTreeSize& size);

/// Crown of leaf cards, and trunk; the origin is at the foot.
std::shared_ptr<TriangleMesh> make_scenery_crown(const SceneryTreeSize& size, int kind);
std::shared_ptr<TriangleMesh> make_scenery_trunk(const SceneryTreeSize& size);

}  // namespace vinerow::render
