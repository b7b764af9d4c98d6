#include "engine/sim/placement_ground.h"

#include <algorithm>

#include "engine/api/world_model.h"

namespace vinerow {

PlacementGround::PlacementGround(const WorldModel& world, const SceneQuery& scene)
    : world_(world), scene_(scene) {
  has_terrain_mesh_ =
      std::any_of(world.meshes.begin(), world.meshes.end(), [](const MeshInstance& instance) {
        return instance.collides && instance.surface == SurfaceClass::kTerrain;
      });
}

std::optional<double> PlacementGround::height_m(double x, double y) const {
  const auto terrain = terrain_m(x, y, kFromAbove_m);
  return terrain ? terrain : scene_.ground_height_m(x, y, kFromAbove_m);
}

std::optional<double> PlacementGround::height_near_m(double x, double y, double here_m,
                                                     bool obstacles, double distance_m) const {
  constexpr double kSteepest = 1.0;  // tan 45 deg; steeper ground is no place for a wheel
  const double rise_m = kSteepest * distance_m;
  const auto height =
      obstacles ? scene_.ground_height_m(x, y, here_m + rise_m) : terrain_m(x, y, here_m + rise_m);
  return height && *height >= here_m - rise_m ? height : std::nullopt;
}

std::optional<double> PlacementGround::terrain_m(double x, double y, double z_from) const {
  std::optional<double> highest;
  if (world_.terrain && world_.terrain->contains(x, y)) {
    const double height = world_.terrain->height_m(x, y);
    if (height <= z_from) highest = height;
  }
  if (!has_terrain_mesh_) return highest;
  const auto hit = scene_.cast_ray({x, y, z_from}, -Eigen::Vector3d::UnitZ(), z_from + kFromAbove_m,
                                   mask_of(SurfaceClass::kTerrain));
  if (hit && hit->mesh >= 0) highest = z_from - hit->distance_m;
  return highest;
}

}  // namespace vinerow
