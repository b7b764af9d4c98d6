#pragma once
/// Refuses worlds that physics cannot be built from, and says who takes part in what.

#include "engine/api/forward.h"
#include "engine/api/mesh.h"
#include "engine/api/surface.h"

namespace vinerow::physics {

/// @throws ConfigError naming the mesh or terrain, what is wrong and what is allowed
void check_world(const WorldModel& world);

/// Rays miss wires: one of 5 mm is narrower than the beams and footprints that rays stand for.
/// Contacts and distances know them.
inline bool is_seen_by_rays(const MeshInstance& instance) {
  return instance.collides && instance.surface != SurfaceClass::kWire;
}

/// What pushes back: all but the canopy, which gives way.
inline bool is_rigid(const MeshInstance& instance) {
  return instance.collides && instance.surface != SurfaceClass::kCanopy;
}

/// What carries a wheel: ground probes are rays.
inline bool carries_wheels(const MeshInstance& instance) {
  return is_rigid(instance) && is_seen_by_rays(instance);
}

}  // namespace vinerow::physics
