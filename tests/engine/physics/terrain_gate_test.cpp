/// The proof that a body is clear of the terrain, and what it must never hide: a contact.

#include "engine/physics/terrain_gate.h"
#include "engine/api/world_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"
#include "tests/engine/physics/small_worlds.h"

namespace vinerow::physics::terrain_gate_test {
namespace {

using Eigen::Vector3d;

const Vector3d kHalf_m(0.6, 0.45, 0.2);
constexpr double kFloor_m = -1.0;

/// Placed by hand, so that it overlaps exactly as far as it was put.
bool touches(const WorldModel& model, const Pose& X_WB, double* depth_m = nullptr) {
  PhysicsWorld world({}, model);
  const BodyId box = world.add_body(test::make_box(kHalf_m, 10.0, {0, 0, 10}));
  world.set_kinematic(box, true);
  world.set_state(box, {X_WB, Vector3d::Zero(), Vector3d::Zero()});
  world.step(world.settings().step);
  bool touching = false;
  for (const Contact& contact : world.contacts()) {
    if (contact.depth_m <= 0.0) continue;
    EXPECT_EQ(contact.surface, SurfaceClass::kTerrain);
    if (depth_m) *depth_m = contact.depth_m;
    touching = true;
  }
  return touching;
}

Eigen::Quaterniond tilted(double roll_deg, double pitch_deg, double yaw_deg) {
  return quaternion_from_rpy(
      {rad_from_deg(roll_deg), rad_from_deg(pitch_deg), rad_from_deg(yaw_deg)});
}

/// A floor with one sample raised so far that it reaches `depth_m` over the lower face of the box.
HeightField spike_under(const Pose& X_WB, const Eigen::Vector2d& at, double depth_m) {
  const Vector3d up = X_WB.q * Vector3d::UnitZ();
  const Eigen::Vector2d away = at - X_WB.p.head<2>();
  // up . (p - origin) = depth - half height
  const double z = X_WB.p.z() + (depth_m - kHalf_m.z() - up.head<2>().dot(away)) / up.z();
  const Vector3d p_B = X_WB.inverse() * Vector3d(at.x(), at.y(), z);
  EXPECT_LT(std::abs(p_B.x()), kHalf_m.x()) << "the spike is beside the box";
  EXPECT_LT(std::abs(p_B.y()), kHalf_m.y()) << "the spike is beside the box";
  return test::make_terrain(41, 41, 0.25, [&](double x, double y) {
    return std::abs(x - at.x()) < 1e-9 && std::abs(y - at.y()) < 1e-9 ? z : kFloor_m;
  });
}

struct Case {
  Pose X_WB;
  Eigen::Vector2d spike;
};

const Case kCases[] = {
    {{tilted(0, 0, 0), {0.03, -0.05, 0.8}}, {0.25, -0.25}},
    {{tilted(0, 20, 0), {0.1, 0.07, 0.9}}, {-0.25, 0.25}},
    {{tilted(-25, 0, 40), {-0.1, 0.02, 0.7}}, {0.0, 0.25}},
    {{tilted(15, -30, 110), {0.05, 0.05, 0.6}}, {0.0, 0.0}},
};

// A vehicle on a slope: the box around it reaches far into the hill, the vehicle does not.
TEST(TerrainGate, ABoxAlongASlopeTouchesWhereItsGapCloses) {
  for (const double slope_deg : {5.0, 15.0, 30.0}) {
    const double slope_rad = rad_from_deg(slope_deg);
    WorldModel model;
    model.terrain =
        test::make_terrain(41, 41, 0.5, [&](double x, double) { return -std::tan(slope_rad) * x; });
    const auto box_at = [&](double gap_m) {
      const Eigen::Quaterniond q(Eigen::AngleAxisd(slope_rad, Vector3d::UnitY()));
      return Pose{q, q * Vector3d(0.1, 0.2, kHalf_m.z() + gap_m)};
    };
    for (const double gap_m : {0.3, 0.05, 0.03, 1e-3}) {
      EXPECT_FALSE(touches(model, box_at(gap_m))) << slope_deg << " deg, gap " << gap_m;
    }
    for (const double depth_m : {1e-3, 0.02}) {
      double reported_m = 0.0;
      EXPECT_TRUE(touches(model, box_at(-depth_m), &reported_m)) << slope_deg << " deg";
      EXPECT_NEAR(reported_m, depth_m, 1e-4) << slope_deg << " deg";
    }
  }
}

TEST(TerrainGate, ASpikeTouchesExactlyWhenItReachesTheLowerFace) {
  for (const Case& test_case : kCases) {
    WorldModel model;
    for (const double depth_m : {-0.2, -0.041, -0.039, -1e-3}) {
      model.terrain = spike_under(test_case.X_WB, test_case.spike, depth_m);
      EXPECT_FALSE(touches(model, test_case.X_WB)) << depth_m;
    }
    for (const double depth_m : {1e-3, 0.02}) {
      model.terrain = spike_under(test_case.X_WB, test_case.spike, depth_m);
      EXPECT_TRUE(touches(model, test_case.X_WB)) << depth_m;
    }
  }
}

/// The proof itself, for a margin of 4 cm: closed form of where it begins to hold.
TEST(TerrainGate, ProvesClearanceUpToTheMargin) {
  constexpr double kMargin_m = 0.04;
  btBoxShape shape(btVector3(kHalf_m.x(), kHalf_m.y(), kHalf_m.z()));
  for (const Case& test_case : kCases) {
    btCollisionObject body;
    body.setCollisionShape(&shape);
    const Eigen::Quaterniond& q = test_case.X_WB.q;
    const Vector3d& p = test_case.X_WB.p;
    body.setWorldTransform(
        btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), btVector3(p.x(), p.y(), p.z())));
    // Heights are floats: 1e-5 m is well above their rounding.
    const auto is_clear = [&](double depth_m) {
      return is_clear_of_terrain(spike_under(test_case.X_WB, test_case.spike, depth_m), body,
                                 kMargin_m);
    };
    EXPECT_TRUE(is_clear(-kMargin_m - 1e-5));
    EXPECT_FALSE(is_clear(-kMargin_m + 1e-5));
    EXPECT_FALSE(is_clear(0.5));
  }
}

TEST(TerrainGate, OutsideItsGridItProvesNothing) {
  const HeightField field = test::make_flat(kFloor_m);  // 20 m x 20 m
  btBoxShape shape(btVector3(kHalf_m.x(), kHalf_m.y(), kHalf_m.z()));
  btCollisionObject body;
  body.setCollisionShape(&shape);
  const auto is_clear_at = [&](double x) {
    body.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(x, 0, 3)));
    return is_clear_of_terrain(field, body, 0.04);
  };
  EXPECT_TRUE(is_clear_at(9.3));
  EXPECT_FALSE(is_clear_at(9.7));
  EXPECT_FALSE(is_clear_at(-50.0));
}

}  // namespace
}  // namespace vinerow::physics::terrain_gate_test
