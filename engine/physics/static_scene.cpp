#include "engine/physics/static_scene.h"

#include "engine/physics/check_world.h"
#include "engine/physics/static_geometry.h"

namespace vinerow::physics {
namespace {

std::shared_ptr<const WorldModel> checked_world(std::shared_ptr<const WorldModel> world) {
  check_world(*world);
  return world;
}

}  // namespace

StaticScene::StaticScene(std::shared_ptr<const WorldModel> world)
    : world_(checked_world(std::move(world))),
      queries_(*world_),
      normals_(*world_),
      geometry_(std::make_unique<const StaticGeometry>(*world_)) {}

StaticScene::~StaticScene() = default;

void StaticScene::prepare() const {
  queries_.prepare();
  normals_.prepare();
  geometry_->prepare();
  if (has_light_) light_->meshes().prepare();
}

const RayScene& StaticScene::light() const {
  std::call_once(light_once_, [this] {
    light_ = std::make_unique<const SurfaceRays>(*world_, queries_.terrain(), is_seen_by_light);
    has_light_ = true;
  });
  return *light_;
}

}  // namespace vinerow::physics
