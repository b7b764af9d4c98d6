#pragma once
/// Rays against the triangle meshes of a world, on Embree. Only this class includes it.
///
/// Embree searches a tree of slightly enlarged boxes in single precision and returns every triangle
/// whose box the ray may meet. `TriangleRay` decides in double precision, from the triangle's own
/// vertices. The hit therefore does not depend on Embree's code, which differs between processors,
/// and a parcel hundreds of metres wide costs no accuracy. A mesh with several instances is stored
/// once.

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"

namespace vinerow::physics {

class MeshRays {
 public:
  /// @param world  checked (check_world.h); outlives this object
  explicit MeshRays(const WorldModel& world);
  ~MeshRays();

  bool empty() const;
  /// First hit. @param dir_W unit. No heap, thread safe.
  std::optional<RayHit> cast(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                             double max_distance_m, SurfaceMask mask) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::physics
