#pragma once
/// Refuses worlds that physics cannot be built from, and says who takes part in what.

#include "engine/api/forward.h"
#include "engine/api/mesh.h"
#include "engine/api/surface.h"

namespace vinerow::physics {

/// @throws ConfigError naming the mesh or terrain, what is wrong and what is allowed
void check_world(const WorldModel& world);

/// Rays and distances see canopy, but no wires, which are drawn only.
inline bool is_seen_by_rays(const MeshInstance& instance) {
  return instance.collides && instance.surface != SurfaceClass::kWire;
}

/// What pushes back: all of that but the canopy, which gives way.
inline bool is_rigid(const MeshInstance& instance) {
  return is_seen_by_rays(instance) && instance.surface != SurfaceClass::kCanopy;
}

}  // namespace vinerow::physics
