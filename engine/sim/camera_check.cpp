#include "engine/sim/camera_check.h"

#include <fmt/format.h>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/sim/placement_ground.h"

namespace vinerow {
namespace {

/// Index of the mesh that encloses a point: horizontal rays to four sides and one upwards all hit
/// it within kClose_m. Below the point there may be other ground. -1 if there is no such mesh.
int find_surrounding(const SceneQuery& scene, const Eigen::Vector3d& p_W) {
  constexpr double kClose_m = 3.0;
  constexpr SurfaceMask kRigid = kAllSurfaces & ~mask_of(SurfaceClass::kCanopy);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  int mesh = -1;
  for (const Eigen::Vector3d& direction :
       {x, Eigen::Vector3d(-x), y, Eigen::Vector3d(-y), Eigen::Vector3d::UnitZ().eval()}) {
    const auto hit = scene.cast_ray(p_W, direction, kClose_m, kRigid);
    if (!hit || hit->mesh < 0 || (mesh >= 0 && hit->mesh != mesh)) return -1;
    mesh = hit->mesh;
  }
  return mesh;
}

}  // namespace

void refuse_hidden_cameras(const scenario::PicturesConfig& pictures, const WorldModel& world,
                           const SceneQuery& scene) {
  const PlacementGround ground(world, scene);
  for (const scenario::CameraConfig& camera : pictures.cameras) {
    if (camera.kind != scenario::CameraKind::kFixed) continue;
    const double ground_m = ground.height_m(camera.p_W.x(), camera.p_W.y()).value_or(0.0);
    const int mesh = find_surrounding(scene, camera.p_W + Eigen::Vector3d(0.0, 0.0, ground_m));
    if (mesh < 0) continue;
    throw ConfigError(
        fmt::format("{}: camera '{}' would be inside the {} '{}'; the height in position_m = "
                    "[{:g}, {:g}, {:g}] "
                    "is measured from the ground",
                    camera.where.text(), camera.name, to_string(world.meshes[mesh].surface),
                    world.meshes[mesh].name, camera.p_W.x(), camera.p_W.y(), camera.p_W.z()));
  }
}

}  // namespace vinerow
