#pragma once
/// Meshes of fruit trees: a trunk with boughs and a round crown.

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/parameters.h"
#include "worlds/mapping/model/row_curve.h"
#include "worlds/parts/mesh_store.h"
#include "worlds/plants/tree_leaves.h"

namespace vinerow::worlds {

struct TreeParams {
  double height_m = 3.6;
  double crown_base_m = 0.9;
  double crown_width_m = 2.0;   ///< across the row, upper limit
  double crown_length_m = 2.6;  ///< along the row
  double trunk_radius_m = 0.07;
  double leaf_cards = 700.0;  ///< per tree, near level
  int variants = 5;
  std::uint64_t seed = 1;
  std::optional<TreeLeaves> leaves;  ///< absent: cards of leaves
};

/// Appends trees at the stations of a row: "crown_hull/row_03/tree_07" (collides, not drawn),
/// "crown/row_03/tree_07#lod0" to "#lod2" (drawn), "tree_trunk/row_03/tree_07" (collides). Leaves
/// are cards with the picture of a leaf, or those of TreeLeaves: then also "twigs/row_03/tree_07"
/// and "fruit/row_03/tree_07" (flowers or fruit), and light meets them instead of the hull. A tree
/// without leaves has no hull.
void plant_tree_row(WorldModel& world, int row_number, const mapping::RowCurve& row,
                    const std::vector<double>& tree_s_m, const mapping::GroundHeight& ground,
                    const TreeParams& params, MeshStore& store);

}  // namespace vinerow::worlds
