#include "engine/physics/surface_rays.h"

#include <algorithm>
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
  if (!terrain_ || (mask & mask_of(SurfaceClass::kTerrain)) == 0) return hit;
  return with_terrain({p_W, dir_W, max_distance_m}, hit);
}

void SurfaceRays::cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                            SurfaceMask mask) const {
  const bool has_terrain = terrain_ && (mask & mask_of(SurfaceClass::kTerrain)) != 0;
  for (std::size_t at = 0; at < rays.size(); at += MeshRays::kPacket) {
    const std::size_t count = std::min(MeshRays::kPacket, rays.size() - at);
    const auto some = rays.subspan(at, count);
    const auto met = hits.subspan(at, count);
    meshes_.cast_packet(some, met, mask);
    if (!has_terrain) continue;
    for (std::size_t i = 0; i < count; ++i) met[i] = with_terrain(some[i], met[i]);
  }
}

}  // namespace vinerow::physics
