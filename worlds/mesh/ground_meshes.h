#pragma once
/// Which of a world's meshes are its ground, where nobody says so: SDF has no word for it.

#include <cstddef>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::worlds {

/// Mesh instances of one object, e.g. of one file placed once: from `begin` to before `end` in
/// WorldModel::meshes.
struct MeshObject {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// An object can be ground where it is at least 5 m long and wide, has no more than half as much
/// steep surface (over 60 deg, as walls and leaves) as it covers in the plan, and covers at least
/// half of the box around it. Such objects are the ground of the world where they together cover at
/// least half of the box around everything: a hillside in one mesh or in tiles is, a crate or a
/// house beside others is not.
/// @returns indices into `objects`; empty: the world has no such ground
std::vector<std::size_t> find_ground(const std::vector<MeshObject>& objects,
                                     const WorldModel& world);

}  // namespace vinerow::worlds
