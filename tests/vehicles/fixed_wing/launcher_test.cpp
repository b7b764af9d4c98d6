// Launch as even acceleration along a straight path.

#include "vehicles/fixed_wing/launcher.h"

#include <gtest/gtest.h>

namespace vinerow::vehicles::launcher_test {
namespace {

using Eigen::Vector3d;

constexpr double kDt_s = 0.01;
const Vector3d kGround_W(3.0, -2.0, 7.0);

/// 2 m in 0.4 s: 40 steps.
LaunchParams catapult() {
  LaunchParams params;
  params.height_m = 1.5;
  params.elevation_rad = rad_from_deg(30.0);
  params.incidence_rad = rad_from_deg(5.0);
  params.length_m = 2.0;
  params.speed_mps = 10.0;
  return params;
}

TEST(Launcher, HoldsTheVehicleNoseUpAboveTheGround) {
  Launcher launcher;
  EXPECT_FALSE(launcher.holds());
  launcher.hold(catapult(), kGround_W, rad_from_deg(90.0));
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(launcher.holds());
    EXPECT_FALSE(launcher.is_pushing());
    const physics::BodyState& state = launcher.advance();
    EXPECT_LT((state.X_WB.p - Vector3d(3.0, -2.0, 8.5)).norm(), 1e-12);
    EXPECT_EQ(state.v_WB_W, Vector3d::Zero());
    EXPECT_EQ(launcher.acceleration_W(), Vector3d::Zero());
    // Northwards, 35 degrees up; the wing to the west.
    const Vector3d nose = state.X_WB.q * Vector3d::UnitX(), left = state.X_WB.q * Vector3d::UnitY();
    EXPECT_LT(
        (nose - Vector3d(0, std::cos(rad_from_deg(35.0)), std::sin(rad_from_deg(35.0)))).norm(),
        1e-12);
    EXPECT_LT((left - Vector3d(-1, 0, 0)).norm(), 1e-12);
  }
}

TEST(Launcher, PushesEvenlyOverItsLength) {
  Launcher launcher;
  launcher.hold(catapult(), kGround_W, rad_from_deg(90.0));
  const Vector3d start = launcher.state().X_WB.p;
  launcher.push(kDt_s);
  const Vector3d along(0, std::cos(rad_from_deg(30.0)), 0.5);
  EXPECT_LT((launcher.acceleration_W() - 25.0 * along).norm(), 1e-12);  // v^2 / 2 L
  for (int k = 1; k <= 40; ++k) {
    ASSERT_TRUE(launcher.is_pushing()) << k;
    const physics::BodyState& state = launcher.advance();
    const double t_s = k * kDt_s;
    EXPECT_LT((state.v_WB_W - 25.0 * t_s * along).norm(), 1e-12) << k;
    EXPECT_LT((state.X_WB.p - start - 12.5 * t_s * t_s * along).norm(), 1e-12) << k;
  }
  EXPECT_FALSE(launcher.holds());
  EXPECT_NEAR(launcher.state().v_WB_W.norm(), 10.0, 1e-12);
  EXPECT_NEAR((launcher.state().X_WB.p - start).norm(), 2.0, 1e-12);
}

TEST(Launcher, AWholeNumberOfStepsKeepsTheSpeedAndMissesTheLengthByLessThanOne) {
  for (const double length_m : {0.97, 1.33, 2.04}) {
    LaunchParams params = catapult();
    params.length_m = length_m;
    Launcher launcher;
    launcher.hold(params, kGround_W, 0.0);
    launcher.push(kDt_s);
    int steps = 0;
    while (launcher.holds()) {
      launcher.advance();
      ASSERT_LT(++steps, 100);
    }
    EXPECT_NEAR(launcher.state().v_WB_W.norm(), 10.0, 1e-12);
    const double pushed_m = (launcher.state().X_WB.p - kGround_W - Vector3d(0, 0, 1.5)).norm();
    EXPECT_NEAR(pushed_m, 0.5 * 10.0 * steps * kDt_s, 1e-12);
    EXPECT_LE(std::abs(pushed_m - length_m), 0.25 * 10.0 * kDt_s + 1e-12);
  }
}

TEST(Launcher, APushShorterThanAStepTakesOne) {
  LaunchParams params = catapult();
  params.length_m = 0.001;
  Launcher launcher;
  launcher.hold(params, kGround_W, 0.0);
  launcher.push(kDt_s);
  launcher.advance();
  EXPECT_FALSE(launcher.holds());
  EXPECT_NEAR(launcher.state().v_WB_W.norm(), 10.0, 1e-12);
}

TEST(Launcher, LetsGoInTheAirAndHoldsAgain) {
  Launcher launcher;
  launcher.hold(catapult(), kGround_W, 0.0);
  launcher.push(kDt_s);
  launcher.advance();
  launcher.release();
  EXPECT_FALSE(launcher.holds());
  EXPECT_FALSE(launcher.is_pushing());
  launcher.hold(catapult(), kGround_W, 0.0);
  EXPECT_TRUE(launcher.holds());
  EXPECT_EQ(launcher.state().v_WB_W, Vector3d::Zero());
  EXPECT_EQ(launcher.acceleration_W(), Vector3d::Zero());
}

}  // namespace
}  // namespace vinerow::vehicles::launcher_test
