/// Rays that are cast together. The judge is each ray alone.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "engine/api/world_model.h"
#include "engine/core/random.h"
#include "engine/physics/world_scene.h"
#include "tests/engine/physics/small_worlds.h"
#include "tests/support/no_alloc.h"

namespace vinerow::physics::rays_together_test {
namespace {

using Eigen::Vector3d;

TEST(Scene, RaysTogetherHitWhatEachHitsAlone) {
  // Hills as a height field, and the same hills as meshes that stand three times: terrain, meshes
  // and instances in one packet.
  WorldModel world;
  world.terrain = test::make_hills();
  const auto mesh = test::make_mesh_of(*world.terrain);
  for (const double x : {-12.0, 3.0, 9.0}) {
    world.meshes.push_back(
        test::make_instance("hill", mesh, Vector3d(x, 1.0, 2.0), SurfaceClass::kCanopy));
  }
  const WorldScene scene(world);
  scene.prepare();
  RandomStream random(1, "", "packets");
  std::vector<SceneRay> rays;
  for (int fan = 0; fan < 400; ++fan) {
    const Vector3d p(random.uniform(-15, 15), random.uniform(-15, 15), random.uniform(26, 46));
    const Vector3d middle = test::random_direction(random);
    // Narrow fans as a laser's beam, and any directions.
    const double width = fan % 2 == 0 ? 0.01 : 1.0;
    for (int i = 0; i < 11; ++i) {
      rays.push_back({p, (middle + width * test::random_direction(random)).normalized(),
                      random.uniform(1.0, 40.0)});
    }
  }
  rays[5].dir_W.x() = std::nan("");
  rays[17].max_distance_m = -1.0;
  for (const SurfaceMask mask : {kAllSurfaces, mask_of(SurfaceClass::kCanopy)}) {
    std::vector<std::optional<RayHit>> hits(rays.size());
    const auto blocked = std::make_unique<bool[]>(rays.size());
    const vinerow::test::AllocationCounter counter;
    scene.cast_rays(rays, hits, mask);
    scene.find_blocked(rays, {blocked.get(), rays.size()}, mask);
    EXPECT_EQ(counter.count(), 0u);
    int met = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto alone = scene.cast_ray(rays[i].p_W, rays[i].dir_W, rays[i].max_distance_m, mask);
      ASSERT_EQ(hits[i].has_value(), alone.has_value()) << i;
      ASSERT_EQ(blocked[i], alone.has_value()) << i;
      if (!alone) continue;
      ++met;
      EXPECT_EQ(hits[i]->distance_m, alone->distance_m);
      EXPECT_EQ(hits[i]->normal_W, alone->normal_W);
      EXPECT_EQ(hits[i]->surface, alone->surface);
      EXPECT_EQ(hits[i]->mesh, alone->mesh);
    }
    EXPECT_GT(met, 500);
  }
}

// Rays of a fan over terrain share what is known of their origin.
TEST(Scene, RaysOverTerrainMeetTogetherWhatTheyMeetAlone) {
  WorldModel world;
  world.terrain = test::make_hills();
  const WorldScene scene(world);
  RandomStream random(3, "test", "fans");
  std::vector<SceneRay> rays;
  for (int fan = 0; fan < 600; ++fan) {
    const double x = random.uniform(-11, 11), y = random.uniform(-11, 11);
    // Fans from high up, from near the ground and from close to it follow each other; some start
    // below it.
    const double up_m = fan % 3 == 0   ? 60.0
                        : fan % 3 == 1 ? random.uniform(-0.5, 3.0)
                                       : random.uniform(0.02, 0.4);
    const Vector3d p_W(x, y, world.terrain->height_m(x, y) + up_m);
    for (int i = 0; i < 8; ++i) {
      const double yaw = random.uniform(-3.1, 3.1), pitch = random.uniform(-0.9, 0.5);
      const double range_m = random.uniform(0.3, i % 2 == 0 ? 3.0 : 80.0);
      rays.push_back(
          {p_W,
           {std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch)},
           range_m});
    }
  }
  std::vector<std::optional<RayHit>> hits(rays.size());
  const auto blocked = std::make_unique<bool[]>(rays.size());
  scene.cast_rays(rays, hits, kAllSurfaces);
  scene.find_blocked(rays, {blocked.get(), rays.size()}, kAllSurfaces);
  int met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto alone =
        scene.cast_ray(rays[i].p_W, rays[i].dir_W, rays[i].max_distance_m, kAllSurfaces);
    ASSERT_EQ(hits[i].has_value(), alone.has_value()) << i;
    ASSERT_EQ(blocked[i], alone.has_value()) << i;
    if (!alone) continue;
    ++met;
    EXPECT_EQ(hits[i]->distance_m, alone->distance_m) << i;
  }
  EXPECT_GT(met, 1000);
  EXPECT_LT(met, 3800);
}

}  // namespace
}  // namespace vinerow::physics::rays_together_test
