#pragma once
/// Leaves for pictures: cards with a leaf picture, scattered through the canopy's outer shell.
///
/// Shading normals point away from the row's middle (blended with the card's own), so that a hedge
/// of cards is lit as a soft body; colours darken towards the inside, where a real canopy shades
/// itself.

#include <functional>

#include "engine/api/mesh.h"
#include "engine/core/random.h"
#include "worlds/parts/canopy.h"

namespace vinerow::worlds {

/// How many cards, and how large, at one level of detail.
struct FoliageDetail {
  double cards_per_m;    ///< of row; for a tree: cards in all
  double card_length_m;  ///< mean
};

/// Levels 0 (near) to 2 (far) that show the same amount of leaf area.
/// @param level  0, 1 or 2
FoliageDetail vine_foliage_detail(double leaf_cards_per_m, int level);
FoliageDetail tree_foliage_detail(double leaf_cards, int level);

/// Cards of one stretch, in its local frame (u along x, lateral y, height z).
TriangleMesh make_vine_foliage(const CanopyShape& shape, const FoliageDetail& detail,
                               RandomStream random);

/// Cards of a round crown around (0, 0, centre height) with the given half axes, m.
TriangleMesh make_crown_foliage(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_axes_m,
                                const FoliageDetail& detail, RandomStream random);

/// Material of all leaves.
Material leaf_material();

}  // namespace vinerow::worlds
