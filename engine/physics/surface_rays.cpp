#include "engine/physics/surface_rays.h"

#include <utility>

namespace vinerow::physics {

SurfaceRays::SurfaceRays(const WorldModel& world, const HeightFieldRay* terrain,
                         bool (*is_met)(const MeshInstance&), std::shared_ptr<MeshTrees> trees)
    : terrain_(terrain), meshes_(world, is_met, std::move(trees)) {}

std::optional<RayHit> SurfaceRays::with_terrain(const SceneRay& ray,
                                                const std::optional<RayHit>& on_mesh) const {
  const auto hit = terrain_->cast(ray.p_W, ray.dir_W, ray.max_distance_m);
  // At the same distance a mesh counts.
  if (!hit || (on_mesh && hit->distance_m >= on_mesh->distance_m)) return on_mesh;
  return RayHit{hit->distance_m, hit->normal_W, SurfaceClass::kTerrain, -1};
}

std::optional<RayHit> SurfaceRays::cast_ray(const Eigen::Vector3d& p_W,
                                            const Eigen::Vector3d& dir_W, double max_distance_m,
                                            SurfaceMask mask) const {
  // Meshes first: most rays of sensors in a row end there, and need no long walk over terrain.
  const std::optional<RayHit> hit = meshes_.cast(p_W, dir_W, max_distance_m, mask);
  if (!meets_terrain(mask)) return hit;
  return with_terrain({p_W, dir_W, hit ? hit->distance_m : max_distance_m}, hit);
}

void SurfaceRays::cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                            SurfaceMask mask) const {
  meshes_.cast_rays(rays, hits, mask);
  if (!meets_terrain(mask)) return;
  HeightFieldRay::Origin origin;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    SceneRay ray = rays[i];
    if (hits[i]) ray.max_distance_m = hits[i]->distance_m;
    if (!terrain_->stays_above(ray, origin)) hits[i] = with_terrain(ray, hits[i]);
  }
}

void SurfaceRays::find_blocked(std::span<const SceneRay> rays, std::span<bool> blocked,
                               SurfaceMask mask) const {
  meshes_.find_blocked(rays, blocked, mask);
  if (!meets_terrain(mask)) return;
  HeightFieldRay::Origin origin;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const SceneRay& ray = rays[i];
    if (blocked[i] || terrain_->stays_above(ray, origin)) continue;
    blocked[i] = terrain_->cast(ray.p_W, ray.dir_W, ray.max_distance_m).has_value();
  }
}

}  // namespace vinerow::physics
