#include "engine/sim/vehicle_rays.h"

#include <algorithm>

#include "engine/sim/vehicle_runtime.h"

namespace vinerow {

VehicleRays::VehicleRays(const std::vector<std::unique_ptr<VehicleRuntime>>& vehicles)
    : vehicles_(vehicles) {
  for (std::size_t v = 0; v < vehicles.size(); ++v) {
    const std::vector<VehicleLink>& all = vehicles[v]->vehicle().links();
    poses_.emplace_back(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!all[i].mesh || all[i].mesh->triangles.empty()) continue;
      MeshInstance link;
      link.name = vehicles[v]->name() + "/" + all[i].name;
      link.mesh = all[i].mesh;
      link.surface = SurfaceClass::kVehicle;
      link.material = all[i].material;
      links_.push_back(std::move(link));
      owner_.push_back(static_cast<int>(v));
      source_.push_back(i);
    }
  }
  read_poses();
  // Vehicles stay within kilometres of the origin; a larger bound costs a little speed.
  constexpr double kReach_m = 5000.0;
  rays_ = std::make_unique<physics::MeshRays>(links_, kReach_m);
}

void VehicleRays::read_poses() {
  for (std::size_t v = 0; v < vehicles_.size(); ++v) vehicles_[v]->vehicle().read_links(poses_[v]);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    links_[i].X_WM = poses_[static_cast<std::size_t>(owner_[i])][source_[i]];
  }
}

void VehicleRays::update() {
  read_poses();
  rays_->move();
}

std::optional<RayHit> VehicleRays::cast_ray(const Eigen::Vector3d& p_W,
                                            const Eigen::Vector3d& dir_W, double max_distance_m,
                                            SurfaceMask mask) const {
  return rays_->cast(p_W, dir_W, max_distance_m, mask);
}

void VehicleRays::cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                            SurfaceMask mask) const {
  rays_->cast_rays(rays, hits, mask);
}

void VehicleRays::find_blocked(std::span<const SceneRay> rays, std::span<bool> blocked,
                               SurfaceMask mask) const {
  rays_->find_blocked(rays, blocked, mask);
}

}  // namespace vinerow
