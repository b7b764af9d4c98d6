/// Standing, landing, and what wrecks a quadrotor.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "tests/vehicles/quadrotor/rig.h"

namespace vinerow::vehicles::contact_test {
namespace {

using namespace test;
using Eigen::Vector3d;

physics::BodyState moving(const Vector3d& p_W, const Vector3d& v_W) {
  physics::BodyState state;
  state.X_WB.p = p_W;
  state.v_WB_W = v_W;
  state.w_WB_W.setZero();
  return state;
}

TEST(QuadrotorGear, StandsAsDrawnWithTheRotorsOff) {
  QuadrotorRig rig;
  rig.run(2.0);
  EXPECT_NEAR(rig.body().X_WB.p.z(), 0.22, 1e-9);
  EXPECT_LT(rig.body().v_WB_W.norm(), 1e-12);
  EXPECT_NEAR(rig.vehicle.specific_force_B().z(), kGravity, 1e-9);
  EXPECT_EQ(rig.crash(), "");
  for (const double speed : rig.vehicle.actuator_states()) EXPECT_EQ(speed, 0.0);
}

TEST(QuadrotorGear, RestsStillOnASlopeOfTenDegrees) {
  for (const double yaw_deg : {0.0, 35.0, 90.0}) {
    QuadrotorRig rig({}, make_slope_world(rad_from_deg(10.0)), 1'000'000, rad_from_deg(yaw_deg));
    rig.run(2.0);
    const Vector3d start = rig.body().X_WB.p;
    rig.run(60.0);
    EXPECT_LT((rig.body().X_WB.p - start).norm(), 1e-9) << yaw_deg;  // asked for: 1e-4
    EXPECT_EQ(rig.crash(), "");
  }
}

TEST(QuadrotorGear, IsNotPutOnASlopeOnWhichItCrashes) {
  QuadrotorParams params;
  params.landing_tilt_limit_rad = rad_from_deg(20.0);
  QuadrotorRig stands(params, make_slope_world(rad_from_deg(19.0)));
  stands.run(0.1);
  EXPECT_EQ(stands.crash(), "");
  try {
    QuadrotorRig(params, make_slope_world(rad_from_deg(21.0)));
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "drone: the ground of its start slopes by 21.0 deg, must be at most "
                 "landing_tilt_limit_deg = 20.0 deg");
  }
}

/// Heave with four dampers: a semi-implicit step is stable for 4 c / m dt + 4 k / m dt^2 / 2 < 2,
/// of which 1.6 are used.
TEST(QuadrotorGear, IsRefusedWhereTheStepIsTooLongForIt) {
  QuadrotorParams params;
  const double limit_Ns_per_m =
      (1.6 - 0.5 * 4.0 * params.foot.stiffness_N_per_m / params.mass_kg * 1e-6) * params.mass_kg /
      4.0 / 1e-3;
  params.foot.damping_Ns_per_m = 0.999 * limit_Ns_per_m;
  QuadrotorRig stands(params);
  stands.run(1.0);
  EXPECT_NEAR(stands.body().X_WB.p.z(), 0.22, 1e-3);  // it trembles, but it stands
  EXPECT_EQ(stands.crash(), "");
  params.foot.damping_Ns_per_m = 1.001 * limit_Ns_per_m;
  try {
    QuadrotorRig{params};
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(),
                testing::ContainsRegex("^drone: physics.step_s = 0.001 s is too long for its "
                                       "landing gear, which with gear_stiffness_N_per_m = 5000, "
                                       "gear_damping_Ns_per_m = 798.[0-9]+ and its mass and "
                                       "inertia is valid to 0.001 s$"));
  }
  // Little inertia: tilt.
  params.foot.damping_Ns_per_m = 50.0;
  params.inertia_kgm2 = {0.001, 0.001, 0.001};
  EXPECT_THROW(QuadrotorRig{params}, ConfigError);
}

/// Coulomb: rubber of 0.8 holds up to 38.66 deg, then slides with g (sin - mu cos).
TEST(QuadrotorGear, HoldsUpToTheFrictionAngle) {
  QuadrotorParams params;
  params.foot.friction = 0.3;  // 16.70 deg, far from toppling
  params.landing_speed_limit_mps = 100.0;
  QuadrotorRig holds(params, make_slope_world(rad_from_deg(16.4)));
  holds.run(3.0);
  EXPECT_LT(holds.body().v_WB_W.norm(), 1e-9);
  QuadrotorRig slides(params, make_slope_world(rad_from_deg(20.0)));
  slides.run(1.0);
  const double before = slides.body().v_WB_W.norm();
  slides.run(1.0);
  const double expected =
      kGravity * (std::sin(rad_from_deg(20.0)) - 0.3 * std::cos(rad_from_deg(20.0)));
  EXPECT_NEAR(slides.body().v_WB_W.norm() - before, expected, 0.02 * expected);
}

TEST(QuadrotorGear, TakesOffAtMoreThanItsWeight) {
  QuadrotorRig rig;
  rig.actuate(320.0);
  rig.run(1.0);
  EXPECT_GT(rig.body().X_WB.p.z(), 0.6);
  EXPECT_LT(rig.tilt_rad(), 1e-6);
  EXPECT_EQ(rig.crash(), "");
}

/// Drops from a height that gives the speed on touch; returns the reason of the crash.
std::string drop(double speed_mps, double tilt_deg = 0.0) {
  QuadrotorRig rig(without_air());
  physics::BodyState state = moving({0, 0, 0.6}, {0, 0, 0});
  state.X_WB.q = quaternion_from_rpy({0.0, rad_from_deg(tilt_deg), 0.0});
  // Lowest foot at its drawn height above the ground it falls to.
  double lowest = 0.0;
  for (std::size_t i = 0; i < kRotors; ++i) {
    lowest = std::min(lowest, (state.X_WB.q * rig.params.foot_B(i)).z());
  }
  state.X_WB.p.z() = -lowest + 0.01;
  state.v_WB_W.z() = -std::sqrt(speed_mps * speed_mps - 2.0 * kGravity * 0.01);
  rig.fly(state, {0, 0, 0, 0});
  rig.run(3.0);
  if (rig.crash().empty()) {
    EXPECT_LT(rig.body().v_WB_W.norm(), 1e-6) << "did not come to rest";
  }
  return rig.crash();
}

TEST(QuadrotorCrash, SoftLandingIsNone) {
  EXPECT_EQ(drop(0.5), "");
  EXPECT_EQ(drop(0.95), "");
  EXPECT_EQ(drop(0.5, 10.0), "");
}

TEST(QuadrotorCrash, HardLandingTellsItsSpeed) {
  EXPECT_EQ(drop(1.1), "hit the ground at 1.1 m/s");
  EXPECT_EQ(drop(2.3), "hit the ground at 2.3 m/s");
}

TEST(QuadrotorCrash, TiltedLandingTellsTheAngle) {
  EXPECT_EQ(drop(0.6, 28.0).find("tilted by 2"), std::string::npos);
  EXPECT_EQ(drop(0.6, 35.0), "touched the ground tilted by 35 deg");
}

TEST(QuadrotorCrash, FallsFromHoverWithTheSpeedOfTheFall) {
  QuadrotorRig rig(without_air());
  rig.fly(2.0 + 0.22, 0.0);
  rig.run(1.0);
  EXPECT_EQ(rig.crash(), "hit the ground at 6.3 m/s");  // sqrt(2 g 2 m) = 6.26
  rig.run(3.0);                                         // physics goes on: it lies on the ground
  EXPECT_LT(rig.body().v_WB_W.norm(), 1e-2);
  EXPECT_GT(rig.body().X_WB.p.z(), 0.0);
}

TEST(QuadrotorCrash, TheGroundMeetsABladeUpsideDown) {
  QuadrotorRig rig(without_air());
  physics::BodyState state = moving({0, 0, 0.08}, {0, 0, 0});
  state.X_WB.q = quaternion_from_rpy({kPi, 0.0, 0.0});
  rig.fly(state, {300, 300, 300, 300});
  rig.actuate(0.0);
  rig.run(0.5);
  EXPECT_EQ(rig.crash().substr(0, 34), "touched the ground with a rotor at");
}

/// Flies sideways into a wall of leaves: wrecked where the discs' edge meets it, and not pushed.
TEST(QuadrotorCrash, LeavesTouchedByABlade) {
  WorldModel world = make_flat_world();
  world.meshes.push_back(
      make_box("row 3", {5.0f, 0.3f, 1.0f}, {0.0, 1.5, 1.0}, SurfaceClass::kCanopy));
  const QuadrotorParams params = without_air();
  QuadrotorRig rig(params, std::move(world));
  const double hover = params.hover_radps();
  rig.fly(moving({0, 0, 1.5}, {0, 1.0, 0}), {hover, hover, hover, hover});
  double touched = -1.0;
  for (int i = 0; i < 1200 && touched < 0.0; ++i) {
    rig.step();
    if (!rig.crash().empty()) touched = rig.body().X_WB.p.y();
  }
  EXPECT_EQ(rig.crash(), "touched the canopy at 1.0 m/s");
  const double edge = 1.5 - 0.3 - (0.31 / std::sqrt(2.0) + 0.19);
  EXPECT_NEAR(touched, edge, 2e-3);
  EXPECT_NEAR(rig.body().v_WB_W.y(), 1.0, 1e-6);
  EXPECT_LT(rig.vehicle.foliage_watch().questions(), 400);  // of 790 steps, all of the last 5 cm
  rig.run(0.3);
  EXPECT_LT(rig.vehicle.rotors()[0].speed_radps, 0.01 * hover);  // the rotors stop
  EXPECT_LT(rig.body().X_WB.p.z(), 1.45);                        // it falls
}

TEST(QuadrotorCrash, NoLeafIsTouchedBesideTheRow) {
  WorldModel world = make_flat_world();
  world.meshes.push_back(
      make_box("row 3", {5.0f, 0.3f, 1.0f}, {0.0, 1.5, 1.0}, SurfaceClass::kCanopy));
  QuadrotorRig rig(without_air(), std::move(world));
  const double hover = rig.params.hover_radps();
  // 4 mm between the discs' edge and the leaves, along the row.
  const double y = 1.2 - (0.31 / std::sqrt(2.0) + 0.19) - 0.004;
  rig.fly(moving({-4.0, y, 1.5}, {4.0, 0, 0}), {hover, hover, hover, hover});
  rig.run(2.0);
  EXPECT_EQ(rig.crash(), "");
}

TEST(QuadrotorCrash, PostObstacleAndVehicleAreNamed) {
  for (const auto& [surface, text] :
       {std::pair{SurfaceClass::kPost, "hit post 'stake 7' with a rotor at 2.0 m/s"},
        std::pair{SurfaceClass::kTrunk, "hit trunk 'stake 7' with a rotor at 2.0 m/s"},
        std::pair{SurfaceClass::kObstacle, "hit obstacle 'stake 7' with a rotor at 2.0 m/s"}}) {
    WorldModel world = make_flat_world();
    world.meshes.push_back(make_box("stake 7", {0.05f, 0.05f, 1.2f}, {2.0, 0.22, 1.2}, surface));
    QuadrotorRig rig(without_air(), std::move(world));
    const double hover = rig.params.hover_radps();
    rig.fly(moving({0, 0, 1.5}, {2.0, 0, 0}), {hover, hover, hover, hover});
    rig.run(1.5);
    EXPECT_EQ(rig.crash(), text);
  }
  QuadrotorRig rig(without_air());
  physics::BodySpec rover;
  rover.name = "rover";
  rover.mass_kg = 200.0;
  rover.X_WB.p = {2.0, 0.0, 1.5};
  rover.shapes = {{physics::BoxShape{{0.5, 0.5, 0.5}}, {}}};
  rig.world.set_kinematic(rig.world.add_body(rover), true);
  const double hover = rig.params.hover_radps();
  rig.fly(moving({0, 0, 1.5}, {2.0, 0, 0}), {hover, hover, hover, hover});
  rig.run(1.0);
  EXPECT_EQ(rig.crash(), "hit rover with a rotor at 2.0 m/s");
}

TEST(QuadrotorCrash, StaysTheFirstReason) {
  QuadrotorRig rig(without_air());
  rig.fly(3.0, 0.0);
  rig.run(1.0);
  const std::string first = rig.crash();
  rig.run(2.0);
  EXPECT_EQ(rig.crash(), first);
  rig.actuate(400.0);
  rig.run(1.0);
  EXPECT_LT(rig.vehicle.rotors()[0].speed_radps, 1.0);  // wrecked: it does not start again
}

}  // namespace
}  // namespace vinerow::vehicles::contact_test
