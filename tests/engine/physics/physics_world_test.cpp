/// The world's own promises: determinism, contacts by name, kinematic bodies, refusals.

#include "engine/physics/physics_world.h"
#include "engine/api/world_model.h"

#include <gtest/gtest.h>

#include <cstring>

#include "engine/core/error.h"
#include "engine/physics/contact_normals.h"
#include "tests/engine/physics/small_worlds.h"
#include "tests/support/no_alloc.h"

namespace vinerow::physics::physics_world_test {
namespace {

using Eigen::Vector3d;

template <class Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

WorldModel make_yard() {
  WorldModel model;
  model.terrain = test::make_hills();
  model.meshes = {test::make_instance("post_1", test::make_box_mesh({0.2f, 0.2f, 2.0f}),
                                      {0, 0, 30.5}, SurfaceClass::kPost),
                  test::make_instance("leaves", test::make_box_mesh({5.0f, 5.0f, 0.2f}),
                                      {0, 0, 34.0}, SurfaceClass::kCanopy)};
  return model;
}

/// Boxes, spheres and a compound that fall into the yard and on each other.
void fill(PhysicsWorld& world) {
  for (int k = 0; k < 6; ++k) {
    const Vector3d p(0.3 * k - 0.8, 0.2 * k - 0.5, 35.0 + 0.6 * k);
    BodySpec spec =
        k % 2 ? test::make_sphere(0.2, 2.0, p) : test::make_box({0.3, 0.2, 0.1}, 3.0, p);
    spec.name += std::to_string(k);
    spec.w_WB_W = {1.0 * k, -2.0, 0.5};
    if (k == 4)
      spec.shapes.push_back(
          {CylinderShape{0.1, 0.3}, {Eigen::Quaterniond::Identity(), {0.2, 0, 0.1}}});
    spec.restitution = 0.3;
    world.add_body(spec);
  }
}

TEST(PhysicsWorld, TwoWorldsGiveTheSameBits) {
  const WorldModel model = make_yard();
  PhysicsWorld first({}, model), second({}, model);
  fill(first);
  fill(second);
  for (int k = 0; k < 3000; ++k) {
    first.step(first.settings().step);
    second.step(second.settings().step);
    for (int b = 0; b < first.body_count(); ++b) {
      const BodyState x = first.state({b}), y = second.state({b});
      ASSERT_EQ(std::memcmp(x.X_WB.p.data(), y.X_WB.p.data(), 24), 0) << "step " << k;
      ASSERT_EQ(std::memcmp(x.X_WB.q.coeffs().data(), y.X_WB.q.coeffs().data(), 32), 0);
      ASSERT_EQ(std::memcmp(x.v_WB_W.data(), y.v_WB_W.data(), 24), 0);
      ASSERT_EQ(std::memcmp(x.w_WB_W.data(), y.w_WB_W.data(), 24), 0);
    }
    ASSERT_EQ(first.contacts().size(), second.contacts().size());
  }
}

TEST(PhysicsWorld, StepsAllocateNothingOnceWarm) {
  const WorldModel model = make_yard();
  PhysicsWorld world({}, model);
  fill(world);
  test::run(world, 3.0);
  EXPECT_FALSE(world.contacts().empty());
  vinerow::test::AllocationCounter counter;
  test::run(world, 0.5);
  EXPECT_EQ(counter.count(), 0u);
}

TEST(PhysicsWorld, ContactsTellSurfaceNameNormalAndLoad) {
  WorldModel model;
  model.terrain = test::make_flat();
  model.meshes = {test::make_instance("post_7", test::make_box_mesh({0.2f, 0.2f, 0.5f}),
                                      {3, 0, 0.5}, SurfaceClass::kPost)};
  PhysicsWorld world({}, model);
  const BodyId on_ground = world.add_body(test::make_box({0.2, 0.2, 0.1}, 4.0, {0.1, 0.1, 0.1}));
  BodySpec rider = test::make_box({0.1, 0.1, 0.1}, 1.0, {0.1, 0.1, 0.3});
  rider.name = "rider";
  const BodyId on_top = world.add_body(rider);
  const BodyId on_post = world.add_body(test::make_sphere(0.1, 1.0, {3.0, 0.05, 1.1}));
  test::run(world, 0.5);
  double ground_Ns = 0.0, top_Ns = 0.0, post_Ns = 0.0;
  for (const Contact& contact : world.contacts()) {
    EXPECT_NEAR(std::abs(contact.normal_W.z()), 1.0, 1e-6);
    if (contact.other.index >= 0) {
      // Reported once, for the body that was added first; the normal points from the other to it.
      EXPECT_EQ(contact.body.index, on_ground.index);
      EXPECT_EQ(contact.other.index, on_top.index);
      EXPECT_EQ(contact.surface, SurfaceClass::kVehicle);
      EXPECT_EQ(world.contact_name(contact), "rider");
      EXPECT_LT(contact.normal_W.z(), 0.0);
      top_Ns += contact.impulse_Ns;
    } else if (contact.body.index == on_post.index) {
      EXPECT_EQ(contact.surface, SurfaceClass::kPost);
      EXPECT_EQ(contact.mesh, 0);
      EXPECT_EQ(world.contact_name(contact), "post_7");
      EXPECT_NEAR(contact.p_W.z(), 1.0, 1e-3);
      post_Ns += contact.impulse_Ns;
    } else {
      EXPECT_EQ(contact.surface, SurfaceClass::kTerrain);
      EXPECT_EQ(contact.mesh, -1);
      EXPECT_EQ(world.contact_name(contact), "terrain");
      ground_Ns += contact.impulse_Ns;
    }
  }
  // Weight times step; the solver's ten sweeps leave some per cent.
  EXPECT_NEAR(ground_Ns, 5.0 * 9.80665e-3, 0.05 * 5.0 * 9.80665e-3);
  EXPECT_NEAR(top_Ns, 1.0 * 9.80665e-3, 0.05 * 9.80665e-3);
  EXPECT_NEAR(post_Ns, 1.0 * 9.80665e-3, 0.01 * 9.80665e-3);
}

TEST(PhysicsWorld, RestingBodyHasNoAcceleration) {
  WorldModel model;
  model.terrain = test::make_flat();
  PhysicsWorld world({}, model);
  const BodyId box = world.add_body(test::make_box({0.3, 0.3, 0.1}, 4.0, {0.1, 0.1, 0.1}));
  test::run(world, 1.0);
  EXPECT_LT(world.acceleration_W(box).norm(), 0.05);
}

TEST(PhysicsWorld, CanopyDoesNotPush) {
  WorldModel model;
  model.terrain = test::make_flat();
  model.meshes = {test::make_instance("leaves", test::make_box_mesh({1, 1, 0.2f}), {0, 0, 2},
                                      SurfaceClass::kCanopy)};
  PhysicsWorld world({}, model);
  const BodyId ball = world.add_body(test::make_sphere(0.1, 1.0, {0, 0, 4}));
  test::run(world, 2.0);
  EXPECT_NEAR(world.state(ball).X_WB.p.z(), 0.1, 1e-3);
}

TEST(PhysicsWorld, NothingPassesThroughAWire) {
  // A trellis wire of 5 mm across the way of a box that flies at 8 m/s, without weight.
  WorldModel model;
  model.meshes = {test::make_instance("wire", test::make_box_mesh({0.0025f, 3.0f, 0.0025f}),
                                      {2, 0, 1}, SurfaceClass::kWire)};
  PhysicsSettings settings;
  settings.gravity_mps2 = 0.0;
  PhysicsWorld world(settings, model);
  BodySpec spec = test::make_box({0.3, 0.3, 0.1}, 2.0, {0, 0, 1});
  spec.v_WB_W = {8, 0, 0};
  const BodyId box = world.add_body(spec);
  double farthest_m = 0.0;
  const Contact* met = nullptr;
  Contact first;
  for (int k = 0; k < 1000; ++k) {
    world.step(settings.step);
    farthest_m = std::max(farthest_m, world.state(box).X_WB.p.x());
    for (const Contact& contact : world.contacts()) {
      if (met != nullptr) continue;
      first = contact;
      met = &first;
    }
  }
  ASSERT_NE(met, nullptr);
  EXPECT_EQ(met->surface, SurfaceClass::kWire);
  EXPECT_EQ(world.contact_name(*met), "wire");
  // Its front stops at the wire; in one step it moves 8 mm.
  EXPECT_NEAR(farthest_m, 2.0 - 0.0025 - 0.3, 0.008);
  EXPECT_LT(world.state(box).v_WB_W.x(), 1e-6);
}

TEST(PhysicsWorld, WheelsRollThroughWiresThatLieBelowThem) {
  WorldModel model;
  model.terrain = test::make_flat();
  model.meshes = {test::make_instance("wire", test::make_box_mesh({1.0f, 1.0f, 0.1f}), {0, 0, 0.2},
                                      SurfaceClass::kWire)};
  const PhysicsWorld world({}, model);
  const auto ground = world.probe_ground({0, 0, 1}, -Eigen::Vector3d::UnitZ(), 2.0);
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->distance_m, 1.0, 1e-9);
  EXPECT_EQ(ground->surface, SurfaceClass::kTerrain);
}

TEST(PhysicsWorld, KinematicBodyStaysWhereItIsPutAndReportsOverlaps) {
  WorldModel model;
  model.terrain = test::make_flat();
  model.meshes = {test::make_instance("post", test::make_box_mesh({0.1f, 0.1f, 1.0f}), {2, 0, 1},
                                      SurfaceClass::kPost)};
  PhysicsWorld world({}, model);
  const BodyId cart = world.add_body(test::make_box({0.5, 0.4, 0.2}, 20.0, {0, 0, 0.3}));
  world.set_kinematic(cart, true);
  const BodyId ball = world.add_body(test::make_sphere(0.1, 1.0, {0, 0, 0.8}));
  bool hit_post = false;
  for (int k = 0; k <= 2000; ++k) {
    BodyState state = world.state(cart);
    state.X_WB.p = {0.001 * k, 0.0, 0.3};
    state.v_WB_W = {1.0, 0, 0};
    world.set_state(cart, state);
    world.step(world.settings().step);
    EXPECT_EQ(world.state(cart).X_WB.p, state.X_WB.p);
    EXPECT_EQ(world.state(cart).v_WB_W, state.v_WB_W);
    for (const Contact& contact : world.contacts()) {
      if (contact.body.index == cart.index && contact.surface == SurfaceClass::kPost) {
        hit_post = true;
        EXPECT_GT(0.001 * k, 2.0 - 0.1 - 0.5 - 0.01);
      }
    }
  }
  EXPECT_TRUE(hit_post);
  EXPECT_NEAR(world.state(ball).X_WB.p.z(), 0.1, 1e-3) << "the ball fell through: pushes nothing";
}

TEST(PhysicsWorld, AHeldBodyStandsLikeAPostAndFallsWhenLetGo) {
  WorldModel model;
  model.terrain = test::make_flat();
  PhysicsWorld world({}, model);
  // In the air, where nothing else would hold it.
  const BodyId held = world.add_body(test::make_box({0.5, 0.5, 0.5}, 20.0, {0, 0, 2.0}));
  world.set_held(held, true);
  EXPECT_TRUE(world.is_kinematic(held));
  const BodyId ball = world.add_body(test::make_sphere(0.1, 1.0, {0, 0, 3.0}));
  test::run(world, 2.0);
  EXPECT_EQ(world.state(held).X_WB.p, Eigen::Vector3d(0, 0, 2.0));
  EXPECT_NEAR(world.state(ball).X_WB.p.z(), 2.6, 2e-3) << "the ball lies on it";
  world.set_held(held, false);
  test::run(world, 2.0);
  EXPECT_NEAR(world.state(held).X_WB.p.z(), 0.5, 2e-3) << "it meets the ground again";
  EXPECT_NEAR(world.state(ball).X_WB.p.z(), 1.1, 4e-3);
}

TEST(PhysicsWorld, AHeldBodySunkIntoTheGroundIsNotPushedOut) {
  WorldModel model;
  model.terrain = test::make_flat();
  PhysicsWorld world({}, model);
  const BodyId box = world.add_body(test::make_box({0.5, 0.5, 0.5}, 20.0, {0, 0, 0.4}));
  world.set_held(box, true);
  test::run(world, 0.5);
  EXPECT_EQ(world.state(box).X_WB.p.z(), 0.4);
  EXPECT_TRUE(world.contacts().empty()) << "the ground is not looked at";
}

TEST(PhysicsWorld, BodyDrivenIntoAPostStops) {
  WorldModel model;
  model.terrain = test::make_flat();
  model.meshes = {test::make_instance("post", test::make_box_mesh({0.05f, 0.05f, 1.0f}), {2, 0, 1},
                                      SurfaceClass::kPost)};
  PhysicsWorld world({}, model);
  BodySpec spec = test::make_box({0.4, 0.3, 0.2}, 20.0, {0, 0.02, 0.2});
  spec.friction = 0.3;
  spec.v_WB_W = {3.0, 0, 0};
  const BodyId cart = world.add_body(spec);
  for (int k = 0; k < 2000; ++k) {
    world.add_central_force_W(cart, {80.0, 0, 0});
    world.step(world.settings().step);
    ASSERT_LT(world.state(cart).X_WB.p.x(), 1.55 + 0.005);
  }
}

TEST(PhysicsWorld, StateThatIsNotFiniteStaysSoAndHarmsNoOther) {
  WorldModel model;
  model.terrain = test::make_flat();
  PhysicsWorld world({}, model);
  const BodyId broken = world.add_body(test::make_box({0.3, 0.3, 0.1}, 4.0, {0.1, 0.1, 0.1}));
  const BodyId well = world.add_body(test::make_box({0.3, 0.3, 0.1}, 4.0, {0.1, 0.1, 0.3}));
  test::run(world, 0.1);
  world.add_central_force_W(broken, {NAN, 0, 0});
  test::run(world, 1.0);
  EXPECT_FALSE(world.state(broken).X_WB.p.allFinite());
  EXPECT_TRUE(world.state(well).X_WB.p.allFinite());
}

TEST(PhysicsWorld, RefusesBadGeometryByName) {
  const auto build = [](const WorldModel& model) {
    return message_of([&] { PhysicsWorld world({}, model); });
  };
  WorldModel model;
  model.meshes = {test::make_instance("row_3", std::make_shared<TriangleMesh>(), {0, 0, 0},
                                      SurfaceClass::kCanopy)};
  EXPECT_EQ(build(model), "mesh 'row_3' has no triangles");

  auto broken = test::make_box_mesh({1, 1, 1});
  broken->triangles[5] = {0, 1, 99};
  model.meshes[0].mesh = broken;
  EXPECT_EQ(build(model), "mesh 'row_3': triangle 5 refers to vertex 99, but there are 8 vertices");
  broken = test::make_box_mesh({1, 1, 1});
  broken->vertices[2].x() = NAN;
  model.meshes[0].mesh = broken;
  EXPECT_EQ(build(model), "mesh 'row_3': vertex 2 is not finite");
  model.meshes[0].mesh = nullptr;
  EXPECT_EQ(build(model), "mesh 'row_3' is missing");
  model.meshes.clear();

  model.terrain = test::make_flat();
  model.terrain->heights_m[42] = NAN;
  EXPECT_EQ(build(model), "terrain: height of sample (1, 1) is not finite");
  model.terrain->heights_m.pop_back();
  EXPECT_EQ(build(model), "terrain has 1680 heights, must be 41 x 41 = 1681");
  model.terrain->rows = 1;
  EXPECT_EQ(build(model), "terrain has 41 x 1 samples, must be 2 x 2 or more");
}

TEST(PhysicsWorld, RefusesBadBodiesByName) {
  const WorldModel model;
  PhysicsWorld world({}, model);
  const auto add = [&](auto&& change) {
    BodySpec spec = test::make_sphere(0.1, 1.0, {0, 0, 0});
    spec.name = "rover";
    change(spec);
    return message_of([&] { world.add_body(spec); });
  };
  EXPECT_EQ(add([](BodySpec& s) { s.mass_kg = -1.0; }), "body 'rover': mass_kg = -1, must be > 0");
  EXPECT_EQ(add([](BodySpec& s) { s.inertia_B(0, 0) = -1.0; }),
            "body 'rover': inertia_B must be symmetric and positive definite");
  EXPECT_EQ(add([](BodySpec& s) {
              s.shapes = {{SphereShape{0.0}, {}}};
            }),
            "body 'rover': radius_m = 0, must be > 0");
  EXPECT_EQ(add([](BodySpec& s) {
              s.shapes = {{HullShape{}, {}}};
            }),
            "body 'rover': hull has 0 points, must be 4 or more");
  EXPECT_EQ(add([](BodySpec& s) { s.X_WB.p.x() = NAN; }),
            "body 'rover': X_WB must be finite with a unit quaternion");
  EXPECT_EQ(add([](BodySpec& s) { s.restitution = 2.0; }),
            "body 'rover': restitution = 2, must be in 0..1");
  EXPECT_EQ(world.body_count(), 0);
}

TEST(ContactNormals, EdgesOfABoxStandOutAndItsDiagonalsAreFlat) {
  const auto box = test::make_box_mesh({1, 1, 1});
  int flat = 0, right_angles = 0;
  for (const auto& triangle : find_edge_bends(*box)) {
    for (const int bend : triangle) {
      flat += bend == 0;
      // A right angle is 63.5 units of pi / 127.
      right_angles += bend == 63 || bend == 64;
    }
  }
  EXPECT_EQ(flat, 12);
  EXPECT_EQ(right_angles, 24);
}

}  // namespace
}  // namespace vinerow::physics::physics_world_test
