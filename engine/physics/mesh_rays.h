#pragma once
/// Rays against the triangle meshes of a world, on Embree. Only this class and its callbacks
/// (block_callbacks.h) include it.
///
/// Embree searches a tree of slightly enlarged boxes in single precision and returns every triangle
/// whose box the ray may meet. `TriangleRay` decides in double precision, from the triangle's own
/// vertices; of rays that go together `PacketRays` rules most out before. The hit therefore does not depend on Embree's code, which differs between processors,
/// and a parcel hundreds of metres wide costs no accuracy. A mesh with several instances is stored
/// once. A mesh that moves is an instance too.
///
/// Embree's trees of a parcel take longer to build than a hundred thousand rays to cast. The first
/// rays search the trees that distances use, mesh by mesh, and hit the same triangles.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/physics/mesh_trees.h"

namespace vinerow::physics {

class MeshRays {
 public:
  /// @param world   checked (check_world.h); outlives this object
  /// @param is_met  of check_world.h
  /// @param trees   for the first rays; null: Embree's trees are built for the first ray
  MeshRays(const WorldModel& world, bool (*is_met)(const MeshInstance&),
           std::shared_ptr<MeshTrees> trees = nullptr);
  /// Meshes that move: each is at X_WM until move().
  /// @param meshes   not empty ones; outlive this object
  /// @param reach_m  bound of the coordinates that they reach
  MeshRays(std::span<const MeshInstance> meshes, double reach_m);
  ~MeshRays();

  /// Moves all meshes of the second constructor to their X_WM.
  void move();

  bool empty() const;
  /// Builds Embree's trees now.
  void prepare() const;
  /// First hit. @param dir_W unit. No heap, thread safe.
  std::optional<RayHit> cast(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                             double max_distance_m, SurfaceMask mask) const;

  /// What cast() returns for each of the rays. @param hits  as many as rays
  void cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                 SurfaceMask mask) const;
  /// Whether cast() returns a hit. The search ends at the first triangle that it finds.
  /// @param blocked  as many as rays
  void find_blocked(std::span<const SceneRay> rays, std::span<bool> blocked,
                    SurfaceMask mask) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::physics
