#pragma once
/// Rays, distances and ground probes on the static world.

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/physics/height_field_ray.h"
#include "engine/physics/mesh_distance.h"
#include "engine/physics/surface_rays.h"

namespace vinerow::physics {

/// Map of the ground cells with a rigid mesh above or below them, so that a wheel queries Embree
/// only there.
class RigidMap {
 public:
  explicit RigidMap(const WorldModel& world);
  bool any_near(double x0, double y0, double x1, double y1) const;

 private:
  void mark(double x0, double y0, double x1, double y1);
  int column_of(double x) const;
  int row_of(double y) const;

  Eigen::Vector2d corner_W_ = {0, 0};
  double cell_m_ = 1.0;
  int columns_ = 0, rows_ = 0;
  std::vector<bool> marked_;
};

class WorldScene : public SceneQuery {
 public:
  /// @param world  checked; outlives this object
  explicit WorldScene(const WorldModel& world);

  void cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                 SurfaceMask mask) const override;
  void find_blocked(std::span<const SceneRay> rays, std::span<bool> blocked,
                    SurfaceMask mask) const override;
  std::optional<RayHit> cast_ray(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                                 double max_distance_m, SurfaceMask mask) const override;
  std::optional<double> ground_height_m(double x, double y, double z_from) const override;
  double distance_to_box_m(const Pose& X_WBox, const Eigen::Vector3d& half_extents_m,
                           double max_distance_m, SurfaceMask mask) const override;

  /// Builds now what rays and distances would build when they first need it.
  void prepare() const;

  /// Implements PhysicsWorld::probe_ground.
  std::optional<RayHit> probe_rigid(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                                    double max_distance_m) const;

  /// Null without a height field.
  const HeightFieldRay* terrain() const { return terrain_ ? &*terrain_ : nullptr; }

 private:
  std::optional<HeightFieldRay> terrain_;
  std::shared_ptr<MeshTrees> trees_;
  SurfaceRays rays_;
  MeshDistance mesh_distance_;
  RigidMap rigid_map_;
  /// Height range of the meshes that are ground; inverted (empty) without such meshes.
  double meshes_top_m_ = -std::numeric_limits<double>::infinity();
  double meshes_bottom_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace vinerow::physics
