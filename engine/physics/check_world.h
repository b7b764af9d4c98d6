#pragma once
/// Validation of worlds for physics, and the roles of their meshes.

#include "engine/api/forward.h"
#include "engine/api/mesh.h"
#include "engine/api/surface.h"

namespace vinerow::physics {

/// @throws ConfigError that names the mesh or terrain, the fault and what is allowed
void check_world(const WorldModel& world);

/// Meshes that rays hit. Rays miss wires: a wire of 5 mm is narrower than the beams and footprints
/// that the rays represent. Contacts and distances include wires.
inline bool is_seen_by_rays(const MeshInstance& instance) {
  return instance.collides && instance.surface != SurfaceClass::kWire;
}

/// Meshes that light meets.
inline bool is_seen_by_light(const MeshInstance& instance) {
  if (!instance.mesh) return false;
  return instance.light == Light::kMeets ||
         (instance.light == Light::kAsDrawn && instance.visible);
}

/// Meshes that push in a contact: all but the canopy, which gives way.
inline bool is_rigid(const MeshInstance& instance) {
  return instance.collides && instance.surface != SurfaceClass::kCanopy;
}

/// Meshes that carry a wheel: ground probes are rays.
inline bool carries_wheels(const MeshInstance& instance) {
  return is_rigid(instance) && is_seen_by_rays(instance);
}

}  // namespace vinerow::physics
