#pragma once
/// Leaves, flowers, fruit and twigs of orchard trees, one by one.
///
/// Leaves are spread evenly through the crown, as many as its volume and their density ask for at
/// the tree's stage. Blades of apples lie flatter, those of olives stand at all angles. Every
/// random number belongs to an organ, whatever the stage: the same tree grows through the season.
/// Figures: docs/models/vines.md.

#include <Eigen/Core>

#include "engine/api/forward.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/core/random.h"
#include "worlds/plants/tree_stage.h"

namespace vinerow::worlds {

struct TreeLeaves {
  Crop crop = Crop::kApple;
  double bbch = 89.0;
  double leaf_area_per_m3 = 2.6;  ///< of crown, in full leaf
  int fruits = 60;                ///< of a tree
};

/// `crop`, `bbch`, `leaf_area_per_m3`, `fruits`.
const ParameterTable<TreeLeaves>& tree_leaves_table();

/// Ellipsoid.
struct CrownSpace {
  Eigen::Vector3d centre;
  Eigen::Vector3d half_axes_m;
};

/// Of a crown at its stage, one side.
double leaf_area_m2(const TreeLeaves& leaves, const CrownSpace& crown);
/// Of a mean blade.
double leaf_width_m(const TreeLeaves& leaves);

/// @param level  0 near, 1, 2 far: fewer and larger leaves with the same area
TriangleMesh make_tree_leaves(const TreeLeaves& leaves, const CrownSpace& crown, int level,
                              RandomStream random);
/// Flowers that are open, or fruit; empty if the tree has neither.
TriangleMesh make_fruit(const TreeLeaves& leaves, const CrownSpace& crown, RandomStream random);
/// Shoots of the last year, on which leaves and fruit grow.
TriangleMesh make_twigs(const CrownSpace& crown, RandomStream random);

}  // namespace vinerow::worlds
