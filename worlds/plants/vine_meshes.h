#pragma once
/// Meshes of a vine's organs at three levels of detail.

#include <vector>

#include "engine/api/mesh.h"
#include "worlds/plants/vine_organs.h"

namespace vinerow::worlds {

/// Blades with the stalks of the near level. @param level  0 near, 1, 2 far: fewer and larger
/// leaves with the same area
TriangleMesh make_leaf_mesh(const std::vector<LeafOrgan>& leaves, int level);
TriangleMesh make_shoot_mesh(const std::vector<ShootOrgan>& shoots, int level);
TriangleMesh make_bunch_mesh(const std::vector<BunchOrgan>& bunches, int level);

}  // namespace vinerow::worlds
