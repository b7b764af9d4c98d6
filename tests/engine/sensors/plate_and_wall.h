#pragma once
/// Vehicles before a sensor: its own and another one.

#include <functional>
#include <memory>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/scene_query.h"
#include "tests/engine/sensors/sensor_bench.h"

namespace vinerow::test {

/// A plate on the sensor's vehicle, 1 m ahead of it, and a wall 8 m along the way, which is
/// another vehicle's.
class PlateAndWall final : public VehicleScene {
 public:
  using Way = std::function<Pose()>;
  explicit PlateAndWall(Way way) : way_(std::move(way)) {
    links_.resize(2);
    links_[0].name = "rover/plate", links_[1].name = "other/wall";
    // Its front looks back at the sensor.
    auto front = std::make_shared<TriangleMesh>();
    front->vertices = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}};
    front->triangles = {{0, 1, 2}};
    links_[0].mesh = links_[1].mesh = front;
    plate_.panels.push_back({{1, 0, 0}, {-1, 0, 0}, SurfaceClass::kVehicle, 0.2, 0.2});
    wall_.panels.push_back({{8, 0, 0}, {-1, 0, 0}, SurfaceClass::kVehicle});
  }

  void update() override { X_WB_ = way_(); }
  std::span<const MeshInstance> links() const override { return links_; }
  int vehicle_of(int link) const override { return link; }
  std::optional<RayHit> cast_ray(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                                 double max_distance_m, SurfaceMask mask) const override {
    auto plate =
        plate_.cast_ray(X_WB_.inverse() * p_W, X_WB_.q.conjugate() * dir_W, max_distance_m, mask);
    auto wall = wall_.cast_ray(p_W, dir_W, max_distance_m, mask);
    if (plate) plate->mesh = plate->triangle = 0, plate->normal_W = X_WB_.q * plate->normal_W;
    if (wall) wall->mesh = 1, wall->triangle = 0;
    return !wall || (plate && plate->distance_m < wall->distance_m) ? plate : wall;
  }

 private:
  Way way_;
  Pose X_WB_;
  std::vector<MeshInstance> links_;
  PlainScene plate_, wall_;
};

}  // namespace vinerow::test
