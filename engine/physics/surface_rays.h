#pragma once
/// Rays on the terrain and on a choice of a world's meshes.

#include <memory>
#include <optional>
#include <span>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/physics/height_field_ray.h"
#include "engine/physics/mesh_rays.h"

namespace vinerow::physics {

class SurfaceRays final : public RayScene {
 public:
  /// @param world    checked; outlives this object
  /// @param terrain  of the world, null if it lacks one; outlives this object
  /// @param is_met   of check_world.h
  /// @param trees    as of MeshRays
  SurfaceRays(const WorldModel& world, const HeightFieldRay* terrain,
              bool (*is_met)(const MeshInstance&), std::shared_ptr<MeshTrees> trees = nullptr);

  std::optional<RayHit> cast_ray(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                                 double max_distance_m, SurfaceMask mask) const override;
  void cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                 SurfaceMask mask) const override;
  void find_blocked(std::span<const SceneRay> rays, std::span<bool> blocked,
                    SurfaceMask mask) const override;

  const MeshRays& meshes() const { return meshes_; }

 private:
  bool meets_terrain(SurfaceMask mask) const {
    return terrain_ && (mask & mask_of(SurfaceClass::kTerrain)) != 0;
  }
  /// The first of a ray's hits on meshes and on the terrain. @pre there is a terrain
  std::optional<RayHit> with_terrain(const SceneRay& ray,
                                     const std::optional<RayHit>& on_mesh) const;

  const HeightFieldRay* terrain_;
  MeshRays meshes_;
};

}  // namespace vinerow::physics
