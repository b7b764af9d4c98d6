#include "engine/physics/surface_rays.h"

#include <utility>

namespace vinerow::physics {

SurfaceRays::SurfaceRays(const WorldModel& world, const HeightFieldRay* terrain,
                         bool (*is_met)(const MeshInstance&), std::shared_ptr<MeshTrees> trees)
    : terrain_(terrain), meshes_(world, is_met, std::move(trees)) {}

std::optional<RayHit> SurfaceRays::with_terrain(SceneRay ray,
                                                const std::optional<RayHit>& on_mesh) const {
  if (on_mesh) ray.max_distance_m = on_mesh->distance_m;
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
  return with_terrain({p_W, dir_W, max_distance_m}, hit);
}

void SurfaceRays::cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                            SurfaceMask mask) const {
  meshes_.cast_rays(rays, hits, mask);
  if (!meets_terrain(mask)) return;
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = with_terrain(rays[i], hits[i]);
}

void SurfaceRays::find_blocked(std::span<const SceneRay> rays, std::span<bool> blocked,
                               SurfaceMask mask) const {
  meshes_.find_blocked(rays, blocked, mask);
  if (!meets_terrain(mask)) return;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const SceneRay& ray = rays[i];
    blocked[i] = blocked[i] || terrain_->cast(ray.p_W, ray.dir_W, ray.max_distance_m);
  }
}

}  // namespace vinerow::physics
