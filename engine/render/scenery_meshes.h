#pragma once
/// Rows and trees of the scenery, cheap enough to be seen from afar by the thousand.

#include <memory>

#include "engine/api/scenery.h"
#include "engine/render/mesh_preparation.h"

namespace vinerow::render {

/// All rows of a field as strips: a ridge with two sides over a row's length, in W. uv: metres
/// along the row; -1 and 1 at the feet, 0 at the top. Colour: the leaves' own, a: a number of the
/// row. Rows lie at whole multiples of the pitch from the field's first corner, as in LandUse.
PreparedMesh make_hedges(const SceneryField& field, const HeightField& terrain);

/// Below each of these rows a curtain from the ground into the leaves, on which the shader draws
/// stems. uv: metres along the row, 0. Normal: across the row. Colour a: as of the row.
PreparedMesh make_stems(const SceneryField& field, const HeightField& terrain);

/// Height of a tree's lowest leaves.
double scenery_crown_base_m(const SceneryTreeSize& size);

/// A crown of leaf cards, and its trunk; the origin is at the foot.
std::shared_ptr<TriangleMesh> make_scenery_crown(const SceneryTreeSize& size, int kind);
std::shared_ptr<TriangleMesh> make_scenery_trunk(const SceneryTreeSize& size);

}  // namespace vinerow::render
