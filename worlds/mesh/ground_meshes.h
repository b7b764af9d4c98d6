#pragma once
/// Detection of the meshes that are a world's ground, because SDF files do not mark them.

#include <cstddef>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::worlds {

/// Mesh instances of one object, e.g. of one file placed once: [begin, end) in WorldModel::meshes.
struct MeshObject {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Finds the objects that are ground. An object is a candidate if it is at least 5 m long and wide,
/// its steep surface (over 60 deg, as walls and leaves) is at most half of its area in plan, and it
/// covers at least half of its bounding box in plan. The candidates are the ground if together they
/// cover at least half of the bounding box of everything. A hillside in one mesh or in tiles is
/// ground; a crate or a house beside others is not.
/// @returns indices into `objects`; empty if the world has no such ground
std::vector<std::size_t> find_ground(const std::vector<MeshObject>& objects,
                                     const WorldModel& world);

}  // namespace vinerow::worlds
