#include "engine/physics/surface_rays.h"

#include <algorithm>

namespace vinerow::physics {

SurfaceRays::SurfaceRays(const WorldModel& world, const HeightFieldRay* terrain,
                         bool (*is_met)(const MeshInstance&))
    : terrain_(terrain), meshes_(world, is_met) {}

std::optional<RayHit> SurfaceRays::cast_on_terrain(const SceneRay& ray) const {
  const auto hit = terrain_->cast(ray.p_W, ray.dir_W, ray.max_distance_m);
  if (!hit) return std::nullopt;
  return RayHit{hit->distance_m, hit->normal_W, SurfaceClass::kTerrain, -1};
}

std::optional<RayHit> SurfaceRays::cast_ray(const Eigen::Vector3d& p_W,
                                            const Eigen::Vector3d& dir_W, double max_distance_m,
                                            SurfaceMask mask) const {
  std::optional<RayHit> first;
  if (terrain_ && (mask & mask_of(SurfaceClass::kTerrain)) != 0) {
    first = cast_on_terrain({p_W, dir_W, max_distance_m});
  }
  const double reach_m = first ? first->distance_m : max_distance_m;
  if (const std::optional<RayHit> hit = meshes_.cast(p_W, dir_W, reach_m, mask)) first = hit;
  return first;
}

void SurfaceRays::cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                            SurfaceMask mask) const {
  const bool has_terrain = terrain_ && (mask & mask_of(SurfaceClass::kTerrain)) != 0;
  for (std::size_t at = 0; at < rays.size(); at += MeshRays::kPacket) {
    const std::size_t count = std::min(MeshRays::kPacket, rays.size() - at);
    const auto some = rays.subspan(at, count);
    const auto met = hits.subspan(at, count);
    // Meshes first: most rays of a scanner in a row end there, and need no long walk over terrain.
    meshes_.cast_packet(some, met, mask);
    if (!has_terrain) continue;
    for (std::size_t i = 0; i < count; ++i) {
      SceneRay ray = some[i];
      if (met[i]) ray.max_distance_m = met[i]->distance_m;
      const std::optional<RayHit> ground = cast_on_terrain(ray);
      // At the same distance a mesh counts, as in cast_ray().
      if (ground && (!met[i] || ground->distance_m < met[i]->distance_m)) met[i] = ground;
    }
  }
}

}  // namespace vinerow::physics
