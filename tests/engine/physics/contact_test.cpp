/// Bodies that touch the ground, against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "tests/engine/physics/small_worlds.h"

namespace vinerow::physics::contact_test {
namespace {

using Eigen::Vector3d;

constexpr double kGravity_mps2 = 9.80665;

WorldModel make_slope(double angle_rad) {
  WorldModel model;
  // 20 m x 20 m; a float's rounding of the heights bends the slope by less than 1e-6 rad.
  model.terrain =
      test::make_terrain(41, 41, 0.5, [&](double x, double) { return -std::tan(angle_rad) * x; });
  return model;
}

/// Box lying on the slope at x = 0.
BodySpec make_box_on_slope(double angle_rad, double friction) {
  const Vector3d half(0.3, 0.2, 0.1);
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle_rad, Vector3d::UnitY()));
  BodySpec spec = test::make_box(half, 5.0, q * Vector3d(0, 0, half.z()));
  spec.X_WB.q = q;
  spec.friction = friction;
  return spec;
}

TEST(Contact, BoxOnASlopeHoldsBelowTheFrictionAngleAndSlidesAbove) {
  for (const double friction : {0.3, 0.6, 0.9}) {
    const double friction_angle_rad = std::atan(friction);
    {
      const double angle_rad = friction_angle_rad * 0.98;
      const WorldModel model = make_slope(angle_rad);
      PhysicsWorld world({}, model);
      const BodyId box = world.add_body(make_box_on_slope(angle_rad, friction));
      const Vector3d start = world.state(box).X_WB.p;
      test::run(world, 2.0);
      EXPECT_LT((world.state(box).X_WB.p - start).norm(), 1e-3) << "friction " << friction;
    }
    {
      const double angle_rad = friction_angle_rad * 1.02;
      const WorldModel model = make_slope(angle_rad);
      PhysicsWorld world({}, model);
      const BodyId box = world.add_body(make_box_on_slope(angle_rad, friction));
      const Vector3d start = world.state(box).X_WB.p;
      test::run(world, 2.0);
      const double slid_m = (world.state(box).X_WB.p - start).norm();
      const double exact_m =
          0.5 * kGravity_mps2 * (std::sin(angle_rad) - friction * std::cos(angle_rad)) * 4.0;
      // The solver's finite sweeps leave the friction uncertain by two parts in a thousand.
      const double friction_mps2 = friction * kGravity_mps2 * std::cos(angle_rad);
      EXPECT_NEAR(slid_m, exact_m, 0.5 * 0.002 * friction_mps2 * 4.0) << "friction " << friction;
    }
  }
}

TEST(Contact, BoxAtRestDoesNotCreep) {
  for (const double angle_deg : {10.0, 25.0}) {
    const double angle_rad = rad_from_deg(angle_deg);
    const WorldModel model = make_slope(angle_rad);
    PhysicsWorld world({}, model);
    const BodyId box = world.add_body(make_box_on_slope(angle_rad, 0.6));
    test::run(world, 1.0);
    const BodyState settled = world.state(box);
    test::run(world, 60.0);
    const BodyState end = world.state(box);
    EXPECT_LT((end.X_WB.p - settled.X_WB.p).norm(), 1e-3) << angle_deg << " deg";
    EXPECT_LT(end.X_WB.q.angularDistance(settled.X_WB.q), 1e-3) << angle_deg << " deg";
    EXPECT_LT(end.v_WB_W.norm(), 1e-3) << angle_deg << " deg";
  }
}

TEST(Contact, BoxRestsOnTheSurfaceAndNotOnAMarginAboveIt) {
  WorldModel on_field;
  on_field.terrain = test::make_flat(2.0);
  WorldModel on_mesh;
  on_mesh.meshes = {test::make_instance("ground", test::make_mesh_of(test::make_flat(2.0)),
                                        Vector3d::Zero(), SurfaceClass::kTerrain)};
  for (const WorldModel* model : std::initializer_list<const WorldModel*>{&on_field, &on_mesh}) {
    PhysicsWorld world({}, *model);
    const BodyId box = world.add_body(test::make_box({0.3, 0.2, 0.1}, 5.0, {0.1, 0.2, 2.15}));
    const BodyId ball = world.add_body(test::make_sphere(0.05, 0.5, {2.1, 0.2, 2.15}));
    test::run(world, 2.0);
    EXPECT_NEAR(world.state(box).X_WB.p.z(), 2.1, 1e-4);
    EXPECT_NEAR(world.state(ball).X_WB.p.z(), 2.05, 1e-4);
    EXPECT_LT(world.state(box).v_WB_W.norm(), 1e-3);
  }
}

TEST(Contact, EveryShapeRestsAtItsHeight) {
  WorldModel model;
  model.terrain = test::make_flat();
  struct Case {
    Shape shape;
    double height_m;
  };
  const std::vector<Vector3d> pyramid = {
      {0.2, 0.2, -0.1}, {-0.2, 0.2, -0.1}, {-0.2, -0.2, -0.1}, {0.2, -0.2, -0.1}, {0, 0, 0.3}};
  const Case cases[] = {{BoxShape{{0.2, 0.2, 0.1}}, 0.1},
                        {SphereShape{0.15}, 0.15},
                        {CylinderShape{0.2, 0.05}, 0.2},
                        {HullShape{pyramid}, 0.1}};
  PhysicsWorld world({}, model);
  std::vector<BodyId> bodies;
  double x = -4.0;
  for (const Case& c : cases) {
    BodySpec spec = test::make_box({0.2, 0.2, 0.1}, 4.0, {x += 1.5, 0.1, c.height_m + 0.05});
    spec.shapes = {{c.shape, {}}};
    bodies.push_back(world.add_body(spec));
  }
  test::run(world, 2.0);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    // The hull's margin is 1 mm.
    EXPECT_NEAR(world.state(bodies[k]).X_WB.p.z(), cases[k].height_m, 1.5e-3) << "case " << k;
  }
}

TEST(Contact, BallBouncesToTheHeightOfItsRestitution) {
  WorldModel model;
  model.terrain = test::make_flat();
  for (const double restitution : {0.0, 0.5, 0.8}) {
    PhysicsWorld world({}, model);
    BodySpec spec = test::make_sphere(0.1, 1.0, {0.13, 0.21, 1.1});
    spec.restitution = restitution;
    const BodyId ball = world.add_body(spec);
    test::run(world, std::sqrt(2.0 / kGravity_mps2) + 0.005);
    double top_m = 0.0;
    for (int k = 0; k < 600; ++k) {
      world.step(world.settings().step);
      top_m = std::max(top_m, world.state(ball).X_WB.p.z() - 0.1);
      if (world.state(ball).v_WB_W.z() < 0.0) break;
    }
    // The impact is placed within a step, before and after: v dt = 4.4 mm of 1 m, twice.
    EXPECT_NEAR(top_m, restitution * restitution, 0.009) << "restitution " << restitution;
  }
}

TEST(Contact, BouncingBallNeverGainsEnergy) {
  WorldModel model;
  model.terrain = test::make_flat();
  PhysicsWorld world({}, model);
  BodySpec spec = test::make_sphere(0.1, 1.0, {0.13, 0.21, 1.1});
  spec.restitution = 0.9;
  spec.v_WB_W = {0.3, 0.0, 0.0};
  spec.w_WB_W = {0.0, 20.0, 0.0};
  const BodyId ball = world.add_body(spec);
  const auto energy_J = [&] {
    const BodyState s = world.state(ball);
    return 0.5 * s.v_WB_W.squaredNorm() + 0.5 * 0.4 * 0.01 * s.w_WB_W.squaredNorm() +
           kGravity_mps2 * s.X_WB.p.z();
  };
  const double start_J = energy_J();
  for (int k = 0; k < 10'000; ++k) {
    world.step(world.settings().step);
    ASSERT_LT(energy_J(), start_J * 1.001) << "step " << k;
  }
}

TEST(Contact, SphereRollsDownAnInclineWithFiveSeventhsOfTheAcceleration) {
  const double angle_rad = rad_from_deg(20.0);
  // On the height field and on a mesh of the same triangles.
  const WorldModel on_field = make_slope(angle_rad);
  WorldModel on_mesh;
  on_mesh.meshes = {test::make_instance("slope", test::make_mesh_of(*on_field.terrain),
                                        Vector3d::Zero(), SurfaceClass::kTerrain)};
  for (const WorldModel* model : std::initializer_list<const WorldModel*>{&on_field, &on_mesh}) {
    PhysicsWorld world({}, *model);
    const Vector3d normal(std::sin(angle_rad), 0.0, std::cos(angle_rad));
    BodySpec spec =
        test::make_sphere(0.1, 1.0, Vector3d(-5.0, 0.1, 5.0 * std::tan(angle_rad)) + 0.1 * normal);
    spec.friction = 0.6;
    const BodyId ball = world.add_body(spec);
    test::run(world, 2.0);
    const double exact_mps = 5.0 / 7.0 * kGravity_mps2 * std::sin(angle_rad) * 2.0;
    const BodyState end = world.state(ball);
    EXPECT_NEAR(end.v_WB_W.norm(), exact_mps, 0.005 * exact_mps);
    // No slip: w r = v.
    EXPECT_NEAR(end.w_WB_W.norm() * 0.1, end.v_WB_W.norm(), 0.005 * exact_mps);
    EXPECT_NEAR(end.w_WB_W.normalized().y(), 1.0, 1e-3);
  }
}

TEST(Contact, SmallSphereDoesNotFallThroughAMesh) {
  // 2 cm sphere at 2 m/s for 8 s over bumps of a mesh with 10 cm triangles.
  WorldModel model;
  const HeightField bumps = test::make_terrain(201, 41, 0.1, [](double x, double y) {
    return 0.02 * std::sin(7.0 * x) * std::cos(5.0 * y) + 0.002 * y * y;
  });
  model.meshes = {test::make_instance("bumps", test::make_mesh_of(bumps), Vector3d::Zero(),
                                      SurfaceClass::kTerrain)};
  PhysicsWorld world({}, model);
  BodySpec spec = test::make_sphere(0.02, 0.1, {-9.5, 0.0, 0.08});
  spec.v_WB_W = {2.0, 0.2, 0.0};
  const BodyId ball = world.add_body(spec);
  for (int k = 0; k < 8000; ++k) {
    world.step(world.settings().step);
    const Vector3d p = world.state(ball).X_WB.p;
    if (!bumps.contains(p.x(), p.y())) break;
    ASSERT_GT(p.z(), bumps.height_m(p.x(), p.y())) << "step " << k;
  }
}

TEST(Contact, BoxSlidesOverTheEdgesInsideAMeshWithoutStumbling) {
  WorldModel model;
  model.terrain = test::make_flat();
  PhysicsWorld world({}, model);
  BodySpec spec = test::make_box({0.3, 0.2, 0.1}, 5.0, {-8.0, 0.07, 0.1});
  spec.friction = 0.2;
  spec.v_WB_W = {6.0, 0.0, 0.0};
  const BodyId box = world.add_body(spec);
  double highest_m = 0.0;
  for (int k = 0; k < 4000; ++k) {
    world.step(world.settings().step);
    highest_m = std::max(highest_m, world.state(box).X_WB.p.z());
  }
  // It stops after v^2 / (2 mu g), flat on the ground.
  EXPECT_NEAR(world.state(box).X_WB.p.x() + 8.0, 36.0 / (2.0 * 0.2 * kGravity_mps2), 0.15);
  EXPECT_LT(highest_m, 0.102);
}

}  // namespace
}  // namespace vinerow::physics::contact_test
