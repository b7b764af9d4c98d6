#pragma once
/// Rays on the links of all vehicles, where they are now.

#include <memory>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/scene_query.h"
#include "engine/physics/mesh_rays.h"

namespace vinerow {

class VehicleRuntime;

class VehicleRays final : public VehicleScene {
 public:
  /// @param vehicles  outlive this object
  explicit VehicleRays(const std::vector<std::unique_ptr<VehicleRuntime>>& vehicles);

  void update() override;
  std::span<const MeshInstance> links() const override { return links_; }
  int vehicle_of(int link) const override { return owner_[static_cast<std::size_t>(link)]; }

  std::optional<RayHit> cast_ray(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                                 double max_distance_m, SurfaceMask mask) const override;
  void cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                 SurfaceMask mask) const override;
  void find_blocked(std::span<const SceneRay> rays, std::span<bool> blocked,
                    SurfaceMask mask) const override;

 private:
  void read_poses();

  const std::vector<std::unique_ptr<VehicleRuntime>>& vehicles_;
  std::vector<MeshInstance> links_;
  std::vector<int> owner_;                ///< number of each link's vehicle
  std::vector<std::size_t> source_;       ///< number of each link in its vehicle
  std::vector<std::vector<Pose>> poses_;  ///< of all links of each vehicle
  std::unique_ptr<physics::MeshRays> rays_;
};

}  // namespace vinerow
