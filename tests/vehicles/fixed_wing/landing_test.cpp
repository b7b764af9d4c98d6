/// On its belly, into leaves and posts.

#include <gtest/gtest.h>

#include "tests/vehicles/fixed_wing/rig.h"

namespace vinerow::vehicles::landing_test {
namespace {

using namespace test;
using Eigen::Vector3d;

/// Just above the ground, sinking, with the motor off.
physics::BodyState over_ground(double speed_mps, double sink_mps, double pitch_rad, double roll_rad,
                               double height_m) {
  physics::BodyState state;
  state.X_WB.p = {-40.0, 0.0, height_m};
  state.X_WB.q = quaternion_from_rpy({roll_rad, -pitch_rad, 0.0});
  state.v_WB_W = {speed_mps, 0.0, -sink_mps};
  state.w_WB_W.setZero();
  return state;
}

TEST(FixedWingLanding, SlidesOnItsBellyAndStays) {
  WingRig rig;
  rig.fly(over_ground(10.0, 0.8, rad_from_deg(6.0), 0.0, 0.3), {0.0, -0.02, -0.02});
  rig.run(8.0);
  EXPECT_EQ(rig.crash(), "");
  const Vector3d rest = rig.body().X_WB.p;
  EXPECT_LT(rig.body().v_WB_W.norm(), 1e-3);
  EXPECT_NEAR(rest.z(), 0.06, 0.01);
  EXPECT_GT((rig.body().X_WB.q * Vector3d::UnitZ()).z(), std::cos(rad_from_deg(10.0)));
  // Coulomb: v^2 / (2 mu g) = 10.2 m at least less what the air takes, and the glide before.
  EXPECT_GT(rest.x() + 40.0, 3.0);
  EXPECT_LT(rest.x() + 40.0, 20.0);
  rig.run(30.0);
  EXPECT_LT((rig.body().X_WB.p - rest).norm(), 1e-3);
}

TEST(FixedWingLanding, StaysOnASlope) {
  WingRig rig(plain_params(), make_slope_world(rad_from_deg(10.0)));
  const Pose lying = pose_on_ground(rig.world_model, 0.0, 0.0, 0.5, 0.062);
  physics::BodyState state;
  state.X_WB = lying;
  state.v_WB_W.setZero();
  state.w_WB_W.setZero();
  rig.fly(state, {0.0, 0.0, 0.0});
  rig.run(3.0);
  const Vector3d rest = rig.body().X_WB.p;
  rig.run(30.0);
  EXPECT_EQ(rig.crash(), "");
  EXPECT_LT((rig.body().X_WB.p - rest).norm(), 1e-3);
  EXPECT_LT((rest - lying.p).norm(), 0.02);
}

TEST(FixedWingLanding, BreaksWhenItSinksTooFast) {
  WingRig rig;
  rig.fly(over_ground(3.0, 3.5, 0.0, 0.0, 0.2), {0.0, 0.0, 0.0});
  rig.run(0.5);
  EXPECT_EQ(rig.crash().substr(0, 39), "hit the ground with its belly, sinking ");
  const std::string cause = rig.crash();
  rig.actuate(1.0, 0.0, 0.0);
  rig.run(1.0);
  EXPECT_EQ(rig.crash(), cause);                      // the first cause stays
  EXPECT_LT(rig.vehicle.actuator_states()[0], 1e-3);  // and the motor is off
}

TEST(FixedWingLanding, BreaksNoseFirst) {
  WingRig rig;
  rig.fly(over_ground(8.0, 9.0, rad_from_deg(-50.0), 0.0, 0.6), {0.0, 0.0, 0.0});
  rig.run(0.5);
  EXPECT_EQ(rig.crash().substr(0, 29), "hit the ground with its nose,");
}

TEST(FixedWingLanding, BreaksWhenTilted) {
  WingRig rig;
  rig.fly(over_ground(3.0, 0.2, 0.0, rad_from_deg(60.0), 0.55), {0.0, 0.0, 0.0});
  rig.run(1.0);
  EXPECT_EQ(rig.crash().substr(0, 29), "touched the ground tilted by ");
}

TEST(FixedWingLanding, IsWreckedByLeavesPostsAndOthers) {
  const auto crash_into = [](SurfaceClass surface) {
    WorldModel world = make_flat_world();
    world.meshes.push_back(make_box("row 3", {0.2f, 2.0f, 1.0f}, {-30.0, 0.0, 1.0}, surface));
    WingRig rig(plain_params(), std::move(world));
    rig.fly(over_ground(12.0, 0.0, rad_from_deg(7.35), 0.0, 1.5), {0.58, -0.0145, -0.0145});
    rig.run(1.0);
    return rig.crash();
  };
  EXPECT_EQ(crash_into(SurfaceClass::kCanopy), "touched the canopy at 12.0 m/s");
  const std::string post = crash_into(SurfaceClass::kPost);
  EXPECT_EQ(post.substr(0, 21), "hit post 'row 3' with");
  EXPECT_EQ(post.substr(post.size() - 12), " at 12.0 m/s");
}

/// The wing tip alone brushes leaves beside the way.
TEST(FixedWingLanding, WatchesItsWingTips) {
  for (const double gap_m : {-0.05, 0.05}) {
    WorldModel world = make_flat_world();
    world.meshes.push_back(make_box("row 3", {3.0f, 0.2f, 1.0f}, {-35.0, 0.45 + 0.2 + gap_m, 1.0},
                                    SurfaceClass::kCanopy));
    WingRig rig(plain_params(), std::move(world));
    rig.fly(over_ground(12.0, 0.0, rad_from_deg(7.35), 0.0, 1.5), {0.5828, -0.0145, -0.0145});
    rig.run(1.0);
    EXPECT_EQ(rig.crash().empty(), gap_m > 0.0) << rig.crash();
  }
}

}  // namespace
}  // namespace vinerow::vehicles::landing_test
