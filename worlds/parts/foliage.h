#pragma once
/// Leaves for display: cards with a leaf texture, scattered through the canopy's outer shell.
///
/// Shading normals point away from the row's middle (blended with the card's own), so that a hedge
/// of cards is lit like a soft body. Colours darken towards the inside, where a real canopy shades
/// itself.

#include <functional>

#include "engine/api/mesh.h"
#include "engine/core/random.h"
#include "worlds/parts/canopy.h"

namespace vinerow::worlds {

/// Number and size of the cards at one level of detail.
struct FoliageDetail {
  double cards_per_m;    ///< per metre of row; for a tree: total
  double card_length_m;  ///< mean
};

/// Levels 0 (near) to 2 (far) with equal leaf area.
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
