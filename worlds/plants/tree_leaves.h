#pragma once
/// Leaves and fruit of orchard trees, one by one.
///
/// Leaves are spread evenly through the crown, as many as its volume and their density ask for.
/// Blades of apples lie flatter, those of olives stand at all angles. Figures:
/// docs/models/vines.md.

#include <Eigen/Core>
#include <cstdint>

#include "engine/api/forward.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/core/random.h"

namespace vinerow::worlds {

enum class Crop : std::uint8_t { kApple, kOlive };

struct TreeLeaves {
  Crop crop = Crop::kApple;
  double leaf_area_per_m3 = 2.6;  ///< of crown
  int fruits = 60;                ///< of a tree
};

/// `crop`, `leaf_area_per_m3`, `fruits`.
const ParameterTable<TreeLeaves>& tree_leaves_table();

/// Ellipsoid.
struct CrownSpace {
  Eigen::Vector3d centre;
  Eigen::Vector3d half_axes_m;
};

/// @param level  0 near, 1, 2 far: fewer and larger leaves with the same area
TriangleMesh make_tree_leaves(const TreeLeaves& leaves, const CrownSpace& crown, int level,
                              RandomStream random);
TriangleMesh make_fruit(const TreeLeaves& leaves, const CrownSpace& crown, RandomStream random);

}  // namespace vinerow::worlds
