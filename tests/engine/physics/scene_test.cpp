/// Rays, ground probes and heights against closed forms; one surface for all who ask.

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include "engine/api/world_model.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "engine/physics/height_field_ray.h"
#include "engine/physics/static_geometry.h"
#include "engine/physics/static_scene.h"
#include "engine/physics/world_scene.h"
#include "tests/engine/physics/small_worlds.h"
#include "tests/support/no_alloc.h"

namespace vinerow::physics::scene_test {
namespace {

using Eigen::Vector3d;

TEST(Scene, BulletEmbreeAndHeightFieldSeeTheSameSurface) {
  WorldModel field_world;
  field_world.terrain = test::make_hills();
  const HeightField& field = *field_world.terrain;
  const StaticGeometry statics(field_world);
  WorldModel mesh_world;
  mesh_world.meshes = {test::make_instance("hills", test::make_mesh_of(field), Vector3d::Zero(),
                                           SurfaceClass::kTerrain)};
  const PhysicsWorld field_physics({}, field_world);
  const PhysicsWorld mesh_physics({}, mesh_world);

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btCollisionWorld bullet(&dispatcher, &broadphase, &configuration);
  const auto objects = statics.make_objects();
  ASSERT_EQ(objects.size(), 1u);
  bullet.addCollisionObject(objects[0].get());

  RandomStream random(1, "", "surface");
  double worst_m = 0.0;
  for (int k = 0; k < 5000; ++k) {
    const double x = random.uniform(-9.99, 9.99), y = random.uniform(-9.99, 9.99);
    const double expected = field.height_m(x, y);
    btCollisionWorld::ClosestRayResultCallback hit({x, y, 50.0}, {x, y, 0.0});
    bullet.rayTest({x, y, 50.0}, {x, y, 0.0}, hit);
    ASSERT_TRUE(hit.hasHit());
    const auto own = field_physics.scene().cast_ray({x, y, 50.0}, -Vector3d::UnitZ(), 100.0);
    const auto embree = mesh_physics.scene().cast_ray({x, y, 50.0}, -Vector3d::UnitZ(), 100.0);
    ASSERT_TRUE(own && embree);
    worst_m = std::max({worst_m, std::abs(hit.m_hitPointWorld.z() - expected),
                        std::abs(50.0 - own->distance_m - expected),
                        std::abs(50.0 - embree->distance_m - expected)});
    EXPECT_LT((own->normal_W - field.normal_W(x, y)).norm(), 1e-9);
  }
  // A wrong diagonal would show as centimetres; what is left is rounding of the vertices' x and y.
  EXPECT_LT(worst_m, 1e-5);
  RecordProperty("worst_nm", std::to_string(worst_m * 1e9));
  bullet.removeCollisionObject(objects[0].get());
}

/// The same ground as a height field and as a mesh.
struct FieldAndMesh {
  explicit FieldAndMesh(HeightField the_field)
      : field_world{world_of(std::move(the_field))},
        mesh_world{mesh_of(field())},
        field_physics({}, field_world),
        mesh_physics({}, mesh_world) {}
  const HeightField& field() const { return *field_world.terrain; }
  std::optional<RayHit> on_field(const Vector3d& p, const Vector3d& dir, double far_m) const {
    return field_physics.scene().cast_ray(p, dir, far_m);
  }
  std::optional<RayHit> on_mesh(const Vector3d& p, const Vector3d& dir, double far_m) const {
    return mesh_physics.scene().cast_ray(p, dir, far_m);
  }

  const WorldModel field_world, mesh_world;
  const PhysicsWorld field_physics, mesh_physics;

 private:
  static WorldModel world_of(HeightField field) {
    WorldModel world;
    world.terrain = std::move(field);
    return world;
  }
  static WorldModel mesh_of(const HeightField& field) {
    WorldModel world;
    world.meshes = {test::make_instance("ground", test::make_mesh_of(field), Vector3d::Zero(),
                                        SurfaceClass::kTerrain)};
    return world;
  }
};

TEST(Scene, SlantedRaysAgreeBetweenTheHeightFieldAndItsMesh) {
  const FieldAndMesh ground(test::make_hills(129, 0.25));
  RandomStream random(2, "", "slanted");
  int hits = 0, different = 0;
  for (int k = 0; k < 20'000; ++k) {
    const Vector3d p(random.uniform(-25, 25), random.uniform(-25, 25), random.uniform(25, 35));
    const Vector3d dir = test::random_direction(random);
    const auto own = ground.on_field(p, dir, 60.0);
    const auto embree = ground.on_mesh(p, dir, 60.0);
    if (own.has_value() != embree.has_value()) {
      ++different;  // rays that graze a ridge or the rim
      continue;
    }
    if (!own) continue;
    ++hits;
    if (std::abs(own->distance_m - embree->distance_m) > 1e-4) ++different;
  }
  EXPECT_GT(hits, 3000);
  EXPECT_LE(different, 4);
}

TEST(Scene, RaysMeetASteepSlopeWhereItsMeshIsMet) {
  const FieldAndMesh ground(test::make_terrain(129, 97, 0.25, [](double x, double y) {
    return 0.05 * std::sin(2.1 * x) * std::cos(1.7 * y) + 0.7 * x - 0.4 * y;
  }));
  RandomStream random(6, "", "steep");
  int hits = 0, misses = 0, different = 0;
  for (int k = 0; k < 40'000; ++k) {
    // About along the slope, up and down, from above and from below.
    const double x = random.uniform(-15, 15), y = random.uniform(-11, 11);
    const double off_m = random.uniform(-0.6, 0.6);
    if (std::abs(off_m) < 1e-3) continue;
    const Vector3d p(x, y, ground.field().height_m(x, y) + off_m);
    const double bearing = random.uniform(-kPi, kPi);
    const Eigen::Vector2d level(std::cos(bearing), std::sin(bearing));
    const double rise = level.dot(Eigen::Vector2d(0.7, -0.4)) + random.uniform(-0.3, 0.3);
    const Vector3d dir = Vector3d(level.x(), level.y(), rise).normalized();
    const auto own = ground.on_field(p, dir, 60.0);
    const auto embree = ground.on_mesh(p, dir, 60.0);
    ++(own ? hits : misses);
    if (own.has_value() != embree.has_value() ||
        (own && std::abs(own->distance_m - embree->distance_m) > 1e-4)) {
      ++different;  // rays that graze a ridge or the rim
    }
  }
  EXPECT_GT(hits, 10'000);
  EXPECT_GT(misses, 5'000);
  EXPECT_LE(different, 20);
}

TEST(Scene, RaysThatRiseFromTheGroundMeetItWhereItsMeshIsMet) {
  const FieldAndMesh ground(test::make_hills(129, 0.25));
  RandomStream random(4, "", "rising");
  int hits = 0, different = 0;
  for (int k = 0; k < 20'000; ++k) {
    const double x = random.uniform(-15, 15), y = random.uniform(-15, 15);
    // From above and from below, so that both steep and gentle rays cross the surface.
    const double off_m = random.uniform(-0.5, 0.5);
    if (std::abs(off_m) < 1e-3) continue;
    const Vector3d p(x, y, ground.field().height_m(x, y) + off_m);
    Vector3d dir = test::random_direction(random);
    dir.z() = std::abs(dir.z());
    const auto own = ground.on_field(p, dir, 60.0);
    const auto embree = ground.on_mesh(p, dir, 60.0);
    if (own) ++hits;
    if (own.has_value() != embree.has_value() ||
        (own && std::abs(own->distance_m - embree->distance_m) > 1e-4)) {
      ++different;  // rays that graze a ridge or the rim
    }
  }
  EXPECT_GT(hits, 5000);
  EXPECT_LE(different, 10);
}

TEST(Scene, ShortRaysMeetTheGroundWhereItsMeshIsMet) {
  const FieldAndMesh ground(test::make_hills(129, 0.25));
  const HeightField& field = ground.field();
  RandomStream random(5, "", "wheels");
  int hits = 0, different = 0;
  for (int k = 0; k < 20'000; ++k) {
    // As those of wheels: within a cell or over a border, and at the rim of the field too.
    const double x = random.uniform(-16, 16), y = random.uniform(-16, 16);
    const Vector3d p(x, y, field.height_m(x, y) + random.uniform(-0.1, 0.4));
    const Vector3d dir =
        Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-2, 0.2))
            .normalized();
    const double reach_m = random.uniform(0.0, 0.6);
    const auto own = ground.on_field(p, dir, reach_m);
    const auto embree = ground.on_mesh(p, dir, reach_m);
    if (own.has_value() != embree.has_value()) {
      ++different;  // rays that end on the surface or at the rim
      continue;
    }
    if (!own) continue;
    ++hits;
    if (std::abs(own->distance_m - embree->distance_m) > 1e-4) ++different;
  }
  EXPECT_GT(hits, 5000);
  EXPECT_LE(different, 4);
}

TEST(Scene, RaysAlongGridLinesAndCornersFindTheGround) {
  const HeightField field = test::make_hills();
  const HeightFieldRay rays(field);
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      const double x = field.corner_W.x() + i * field.cell_m;
      const double y = field.corner_W.y() + j * field.cell_m;
      const auto hit = rays.cast({x, y, 40.0}, -Vector3d::UnitZ(), 20.0);
      ASSERT_TRUE(hit) << i << ", " << j;
      EXPECT_NEAR(40.0 - hit->distance_m, field.height_m(x, y), 1e-9);
    }
  }
  // Along a row of samples, from outside the grid, downwards: every such ray must land.
  for (int j = 0; j < field.rows; ++j) {
    const Vector3d p(-12.0, field.corner_W.y() + j * field.cell_m, 34.0);
    const auto hit = rays.cast(p, Vector3d(2.0, 0.0, -1.0).normalized(), 30.0);
    ASSERT_TRUE(hit) << j;
    const Vector3d at = p + hit->distance_m * Vector3d(2.0, 0.0, -1.0).normalized();
    EXPECT_NEAR(at.z(), field.height_m(at.x(), at.y()), 1e-9);
  }
  EXPECT_FALSE(rays.cast({11.0, 0.0, 40.0}, -Vector3d::UnitZ(), 20.0));
  EXPECT_FALSE(rays.cast({0.0, 0.0, 40.0}, -Vector3d::UnitZ(), 5.0));
  EXPECT_FALSE(rays.cast({std::nan(""), 0.0, 40.0}, -Vector3d::UnitZ(), 20.0));
}

TEST(Scene, FlatGroundIsHitFromBothSidesAndOnIt) {
  WorldModel model;
  model.terrain = test::make_flat(3.0);
  const PhysicsWorld world({}, model);
  const auto above = world.scene().cast_ray({0.1, 0.2, 5.0}, -Vector3d::UnitZ(), 9.0);
  const auto below = world.scene().cast_ray({0.1, 0.2, 1.0}, Vector3d::UnitZ(), 9.0);
  const auto on_it = world.scene().cast_ray({0.1, 0.2, 3.0}, -Vector3d::UnitZ(), 9.0);
  ASSERT_TRUE(above && below && on_it);
  EXPECT_DOUBLE_EQ(above->distance_m, 2.0);
  EXPECT_DOUBLE_EQ(below->distance_m, 2.0);
  EXPECT_DOUBLE_EQ(on_it->distance_m, 0.0);
  EXPECT_EQ(above->normal_W, Vector3d::UnitZ());
  EXPECT_EQ(below->normal_W, -Vector3d::UnitZ());
  EXPECT_EQ(above->mesh, -1);
}

TEST(Scene, RayDistancesAreGoodToAMicrometreFarFromTheOrigin) {
  // A turned box 300 m away: the distance of a ray to a plane in closed form, in double.
  WorldModel model;
  MeshInstance box = test::make_instance("wall", test::make_box_mesh({2.0f, 0.5f, 1.0f}),
                                         {281.3, -173.7, 42.1}, SurfaceClass::kObstacle);
  box.X_WM.q = quaternion_from_rpy({0.2, -0.3, 0.7});
  model.meshes = {box};
  const PhysicsWorld world({}, model);
  RandomStream random(3, "", "far");
  double worst_m = 0.0;
  for (int k = 0; k < 2000; ++k) {
    // Towards a point on the face y = -0.5 of the box, from 4 m in front of it.
    const Vector3d target_M(random.uniform(-1.8, 1.8), -0.5, random.uniform(-0.8, 0.8));
    const Vector3d from_M = target_M + Vector3d(random.uniform(-2, 2), -4.0, random.uniform(-2, 2));
    const Vector3d p_W = box.X_WM * from_M, target_W = box.X_WM * target_M;
    const auto hit = world.scene().cast_ray(p_W, (target_W - p_W).normalized(), 10.0);
    ASSERT_TRUE(hit);
    worst_m = std::max(worst_m, std::abs(hit->distance_m - (target_W - p_W).norm()));
    EXPECT_LT((hit->normal_W - box.X_WM.q * -Vector3d::UnitY()).norm(), 1e-9);
  }
  EXPECT_LT(worst_m, 1e-6);
  RecordProperty("worst_nm", std::to_string(worst_m * 1e9));
}

/// A row with a canopy box in front of a post, a wire in front of both, on flat ground.
WorldModel make_row() {
  WorldModel model;
  model.terrain = test::make_flat();
  model.meshes = {test::make_instance("canopy", test::make_box_mesh({0.2f, 2.0f, 0.5f}), {2, 0, 1},
                                      SurfaceClass::kCanopy),
                  test::make_instance("post", test::make_box_mesh({0.05f, 0.05f, 1.0f}), {3, 0, 1},
                                      SurfaceClass::kPost),
                  test::make_instance("wire", test::make_box_mesh({0.01f, 2.0f, 0.01f}), {1, 0, 1},
                                      SurfaceClass::kWire),
                  test::make_instance("rock", test::make_box_mesh({0.3f, 0.3f, 0.2f}), {-3, 0, 0.1},
                                      SurfaceClass::kObstacle)};
  return model;
}

TEST(Scene, RaysSeeTheClassesOfTheirMask) {
  const WorldModel model = make_row();
  const PhysicsWorld world({}, model);
  const SceneQuery& scene = world.scene();
  const Vector3d p(0, 0, 1), ahead = Vector3d::UnitX();
  const auto all = scene.cast_ray(p, ahead, 10.0);
  ASSERT_TRUE(all);
  EXPECT_NEAR(all->distance_m, 1.8, 1e-6);
  EXPECT_EQ(all->surface, SurfaceClass::kCanopy);
  EXPECT_EQ(all->mesh, 0);
  const auto post = scene.cast_ray(p, ahead, 10.0, mask_of(SurfaceClass::kPost));
  ASSERT_TRUE(post);
  EXPECT_NEAR(post->distance_m, 2.95, 1e-6);
  EXPECT_EQ(post->mesh, 1);
  EXPECT_FALSE(scene.cast_ray(p, ahead, 10.0, mask_of(SurfaceClass::kWire)));
  EXPECT_FALSE(scene.cast_ray(p, ahead, 10.0, mask_of(SurfaceClass::kTerrain)));
  EXPECT_FALSE(scene.cast_ray(p, ahead, 1.7999));
  EXPECT_TRUE(scene.cast_ray(p, ahead, 1.8001));
}

TEST(Scene, RaysFromNowhereMeetNothing) {
  const WorldModel model = make_row();
  const PhysicsWorld world({}, model);
  const SceneQuery& scene = world.scene();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double far : {9.2e18, -9.2e18, 1e39, 1e308, nan, infinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vector3d p(0, 0, 1);
      p[axis] = far;
      EXPECT_FALSE(scene.cast_ray(p, Vector3d::UnitX(), 10.0)) << far << " " << axis;
      EXPECT_FALSE(scene.cast_ray(p, -Vector3d::UnitZ(), 1e30)) << far << " " << axis;
      Vector3d ahead(1, 0, 0);
      ahead[axis] = nan;
      EXPECT_FALSE(scene.cast_ray(Vector3d(0, 0, 1), ahead, 10.0)) << axis;
    }
  }
  EXPECT_FALSE(scene.cast_ray(Vector3d(0, 0, 1), Vector3d::UnitX(), nan));
}

TEST(Scene, GroundIsTerrainOrObstacleBelowThePoint) {
  const WorldModel model = make_row();
  const PhysicsWorld world({}, model);
  const SceneQuery& scene = world.scene();
  EXPECT_NEAR(*scene.ground_height_m(0.0, 0.0, 5.0), 0.0, 1e-9);
  EXPECT_NEAR(*scene.ground_height_m(-3.0, 0.1, 5.0), 0.3, 1e-6);   // on the rock
  EXPECT_NEAR(*scene.ground_height_m(-3.0, 0.1, 0.25), 0.0, 1e-6);  // inside it: not its top
  EXPECT_NEAR(*scene.ground_height_m(2.0, 0.1, 5.0), 0.0, 1e-9);    // canopy is no ground
  EXPECT_FALSE(scene.ground_height_m(0.0, 0.0, -1.0));
  EXPECT_FALSE(scene.ground_height_m(100.0, 0.0, 5.0));
}

TEST(Scene, ProbesStandOnRigidThingsOnly) {
  const WorldModel model = make_row();
  const PhysicsWorld world({}, model);
  const auto probe = [&](double x, double y, double z) {
    return world.probe_ground({x, y, z}, -Vector3d::UnitZ(), 1.0);
  };
  ASSERT_TRUE(probe(0, 0, 0.5));
  EXPECT_DOUBLE_EQ(probe(0, 0, 0.5)->distance_m, 0.5);
  EXPECT_EQ(probe(0, 0, 0.5)->surface, SurfaceClass::kTerrain);
  EXPECT_NEAR(probe(-3.1, 0.1, 0.5)->distance_m, 0.2, 1e-6);
  EXPECT_EQ(probe(-3.1, 0.1, 0.5)->surface, SurfaceClass::kObstacle);
  EXPECT_NEAR(probe(3.0, 0.0, 2.5)->distance_m, 0.5, 1e-6);
  EXPECT_EQ(probe(3.0, 0.0, 2.5)->surface, SurfaceClass::kPost);
  EXPECT_FALSE(probe(2.0, 0.0, 2.0)) << "canopy does not carry";
  EXPECT_FALSE(probe(0, 0, 1.5));
  EXPECT_FALSE(probe(50, 0, 0.5));
}

TEST(Scene, QueriesAllocateNothingAndLeaveFloatingPointAlone) {
  const unsigned before = _mm_getcsr() & ~_MM_EXCEPT_MASK;
  const WorldModel model = make_row();
  const PhysicsWorld world({}, model);
  const SceneQuery& scene = world.scene();
  const auto ask = [&] {
    scene.cast_ray({0, 0, 1}, Vector3d::UnitX(), 10.0);
    scene.ground_height_m(-3.0, 0.0, 5.0);
    scene.distance_to_box_m({}, {0.5, 0.4, 0.3}, 5.0);
    world.probe_ground({-3.0, 0, 0.5}, -Vector3d::UnitZ(), 1.0);
  };
  for (int k = 0; k < 100; ++k) ask();  // trees are built on the way
  vinerow::test::AllocationCounter counter;
  ask();
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_EQ(_mm_getcsr() & ~_MM_EXCEPT_MASK, before);
}

TEST(Scene, SharedMeshesAreSeenWhereTheirInstancesStand) {
  WorldModel model;
  const auto mesh = test::make_box_mesh({0.05f, 0.05f, 1.0f});
  for (int k = 0; k < 50; ++k) {
    model.meshes.push_back(
        test::make_instance("post", mesh, {5.0 * k, 0.0, 1.0}, SurfaceClass::kPost));
  }
  const PhysicsWorld world({}, model);
  for (int k = 0; k < 50; ++k) {
    const auto hit = world.scene().cast_ray({5.0 * k, -2.0, 1.0}, Vector3d::UnitY(), 5.0);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->mesh, k);
    EXPECT_NEAR(hit->distance_m, 1.95, 1e-6);
  }
}

/// Turned boxes of several classes, some on the same mesh.
WorldModel scattered_boxes() {
  WorldModel model;
  RandomStream random(1, "", "boxes");
  const auto shared = test::make_box_mesh({0.5f, 0.2f, 1.0f});
  constexpr SurfaceClass kClasses[] = {SurfaceClass::kCanopy, SurfaceClass::kPost,
                                       SurfaceClass::kObstacle};
  for (int k = 0; k < 12; ++k) {
    const auto mesh = k % 2 == 0 ? shared : test::make_box_mesh({0.3f, 0.4f, 0.1f * (k + 1.0f)});
    const Vector3d p_W(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(0, 4));
    MeshInstance box = test::make_instance("box", mesh, p_W, kClasses[k % 3]);
    box.X_WM.q =
        Eigen::Quaterniond(Eigen::AngleAxisd(random.uniform(0, 3), test::random_direction(random)));
    model.meshes.push_back(box);
  }
  return model;
}

/// The first rays do without Embree, until its trees are worth building.
TEST(Scene, FirstRaysHitWhatEmbreeHits) {
  WorldModel model = scattered_boxes();
  const HeightField hills = test::make_hills(129, 0.25);
  for (const double z : {0.0, -3.0}) {  // two instances of one mesh
    static const auto mesh = test::make_mesh_of(hills);
    model.meshes.push_back(
        test::make_instance("hills", mesh, {0, 0, z - 28.0}, SurfaceClass::kPost));
  }
  const WorldScene fresh(model), built(model);
  built.prepare();
  RandomStream random(5, "", "first rays");
  int met = 0;
  // A search without Embree for every fourth triangle: 16,400.
  for (int k = 0; k < 12'000; ++k) {
    std::array<SceneRay, 3> rays;
    for (SceneRay& ray : rays) {
      ray.p_W = {random.uniform(-12, 12), random.uniform(-12, 12), random.uniform(-4, 8)};
      ray.dir_W = k % 8 == 0 ? Vector3d(-Vector3d::UnitZ()) : test::random_direction(random);
      ray.max_distance_m = random.uniform(0.0, 20.0);
    }
    const SurfaceMask mask = k % 3 == 0 ? mask_of(SurfaceClass::kPost) : kAllSurfaces;
    std::array<std::optional<RayHit>, 3> first, later;
    if (k % 2 == 0) {
      fresh.cast_rays(rays, first, mask);
    } else {
      for (std::size_t i = 0; i < rays.size(); ++i) {
        first[i] = fresh.cast_ray(rays[i].p_W, rays[i].dir_W, rays[i].max_distance_m, mask);
      }
    }
    built.cast_rays(rays, later, mask);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(first[i].has_value(), later[i].has_value()) << k;
      if (!later[i]) continue;
      ++met;
      ASSERT_EQ(first[i]->distance_m, later[i]->distance_m) << k;
      ASSERT_EQ(first[i]->normal_W, later[i]->normal_W) << k;
      ASSERT_EQ(first[i]->mesh, later[i]->mesh) << k;
      ASSERT_EQ(first[i]->triangle, later[i]->triangle) << k;
    }
  }
  EXPECT_GT(met, 10'000);
}

TEST(Scene, TheFirstRayOfASceneHitsWhatLaterOnesHit) {
  const WorldModel model = scattered_boxes();
  const WorldScene built(model);
  built.prepare();
  RandomStream random(2, "", "rays");
  int met = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vector3d p_W(random.uniform(-12, 12), random.uniform(-12, 12), random.uniform(-2, 6));
    Vector3d dir_W = test::random_direction(random);
    if (k % 8 == 0) dir_W = Vector3d::Unit(k / 8 % 3);  // along the sides of boxes
    const double max_m = random.uniform(0.0, 20.0);
    const SurfaceMask mask = k % 3 == 0 ? mask_of(SurfaceClass::kPost) : kAllSurfaces;
    const WorldScene fresh(model);
    const auto first = fresh.cast_ray(p_W, dir_W, max_m, mask);
    const auto later = built.cast_ray(p_W, dir_W, max_m, mask);
    ASSERT_EQ(first.has_value(), later.has_value()) << k;
    if (!later) continue;
    ++met;
    EXPECT_EQ(first->distance_m, later->distance_m);
    EXPECT_EQ(first->mesh, later->mesh);
    EXPECT_EQ(first->triangle, later->triangle);
  }
  EXPECT_GT(met, 50);
}

TEST(Scene, APreparedSceneBuildsNothingLater) {
  auto model = std::make_shared<WorldModel>(scattered_boxes());
  const StaticScene scene(model);
  static_cast<void>(scene.light());
  scene.prepare();
  RandomStream random(4, "", "prepared");
  const vinerow::test::AllocationCounter counter;
  for (int k = 0; k < 100; ++k) {
    const Vector3d p_W(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(0, 4));
    const Vector3d dir_W = test::random_direction(random);
    scene.queries().cast_ray(p_W, dir_W, 20.0, kAllSurfaces);
    scene.light().cast_ray(p_W, dir_W, 20.0);
    Pose X_WBox;
    X_WBox.p = p_W;
    scene.queries().distance_to_box_m(X_WBox, {0.5, 0.4, 0.3}, 5.0, kAllSurfaces);
  }
  EXPECT_EQ(counter.count(), 0u);
}

TEST(Scene, SeveralThreadsMayBeTheFirst) {
  const WorldModel model = scattered_boxes();
  const WorldScene alone(model);
  const auto ask = [](const WorldScene& scene) {
    std::vector<double> answers;
    RandomStream random(3, "", "first");
    for (int k = 0; k < 200; ++k) {
      const Vector3d p_W(random.uniform(-12, 12), random.uniform(-12, 12), random.uniform(-2, 6));
      const auto hit = scene.cast_ray(p_W, test::random_direction(random), 20.0, kAllSurfaces);
      answers.push_back(hit ? hit->distance_m : -1.0);
      Pose X_WBox;
      X_WBox.p = p_W;
      answers.push_back(scene.distance_to_box_m(X_WBox, {0.5, 0.4, 0.3}, 5.0, kAllSurfaces));
    }
    return answers;
  };
  const std::vector<double> expected = ask(alone);
  for (int round = 0; round < 10; ++round) {
    const WorldScene scene(model);
    std::array<std::vector<double>, 4> answers;
    {
      std::vector<std::jthread> threads;
      for (auto& own : answers) threads.emplace_back([&] { own = ask(scene); });
    }
    for (const auto& own : answers) EXPECT_EQ(own, expected);
  }
}

TEST(Scene, LightMeetsWhatIsDrawnAndWhatStandsForIt) {
  const auto ball = test::make_mesh_of(test::make_hills());
  WorldModel world;
  const auto add = [&](double z, SurfaceClass surface, bool collides, bool visible, Light light) {
    MeshInstance instance = test::make_instance("layer", ball, Vector3d(0, 0, z), surface);
    instance.collides = collides;
    instance.visible = visible;
    instance.light = light;
    world.meshes.push_back(instance);
  };
  // From above: what the ray at (1, 1) meets first shows which layers it passes. The hills are some
  // 30 m high.
  add(50.0, SurfaceClass::kObstacle, true, false, Light::kAsDrawn);  // a box of collisions
  add(40.0, SurfaceClass::kCanopy, false, true, Light::kPasses);     // cards of leaves
  add(30.0, SurfaceClass::kWire, true, true, Light::kAsDrawn);
  add(20.0, SurfaceClass::kCanopy, true, false, Light::kMeets);  // a hull without leaves
  add(10.0, SurfaceClass::kObstacle, false, true, Light::kAsDrawn);
  const PhysicsWorld physics({}, world);
  const auto first = [](const RayScene& scene, double from_z) {
    const auto hit = scene.cast_ray({1.0, 1.0, from_z}, -Vector3d::UnitZ(), 500.0);
    return hit ? hit->mesh : -1;
  };
  EXPECT_EQ(first(physics.light_scene(), 130.0), 2);
  EXPECT_EQ(first(physics.light_scene(), 58.0), 3);
  EXPECT_EQ(first(physics.light_scene(), 48.0), 4);
  EXPECT_EQ(first(physics.scene(), 130.0), 0);
  EXPECT_EQ(first(physics.scene(), 78.0), 3);  // neither cards nor wires
  EXPECT_EQ(first(physics.scene(), 48.0), -1);
}

}  // namespace
}  // namespace vinerow::physics::scene_test
