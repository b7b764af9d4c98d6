#include "vehicles/parts/ground_effect.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vinerow::vehicles::ground_effect_test {
namespace {

TEST(GroundEffect, OneRotorFollowsCheesemanAndBennett) {
  const GroundEffect effect(GroundEffectModel::kSingle, 0.2, 0.3, 2.0);
  EXPECT_NEAR(effect.thrust_ratio(0.2), 16.0 / 15.0, 1e-12);  // z = R
  EXPECT_NEAR(effect.thrust_ratio(0.1), 4.0 / 3.0, 1e-12);    // z = R / 2
  EXPECT_NEAR(effect.thrust_ratio(0.4), 64.0 / 63.0, 1e-12);  // z = 2 R
}

/// Images summed one by one: a source below each rotor pushes up with R^2 / 4 cos / distance^2.
TEST(GroundEffect, FourRotorsAreTheSumOfTheirImages) {
  const double R = 0.19, arm = 0.31;
  const GroundEffect bare(GroundEffectModel::kMultirotor, R, arm, 0.0);
  for (const double z : {0.15, 0.3, 0.6, 1.2}) {
    double wake = 0.0;
    for (int i = 0; i < 4; ++i) {
      const double angle = 1.5707963267948966 * i;
      const double dx = arm * (std::cos(angle) - 1.0), dy = arm * std::sin(angle);
      const double distance2 = dx * dx + dy * dy + 4.0 * z * z;
      wake += R * R / 4.0 * 2.0 * z / (distance2 * std::sqrt(distance2));
    }
    EXPECT_NEAR(bare.thrust_ratio(z), 1.0 / (1.0 - wake), 1e-12) << z;
    const GroundEffect whole(GroundEffectModel::kMultirotor, R, arm, 2.0);
    const double b2 = 4.0 * arm * arm;
    wake += 2.0 * R * R * z * 2.0 / std::pow(b2 + 4.0 * z * z, 1.5);
    EXPECT_NEAR(whole.thrust_ratio(z), 1.0 / (1.0 - wake), 1e-12) << z;
  }
}

TEST(GroundEffect, IsBoundedAndEnds) {
  const GroundEffect effect(GroundEffectModel::kMultirotor, 0.19, 0.31, 2.0);
  EXPECT_LE(effect.thrust_ratio(0.0), GroundEffect::kMaxRatio);
  EXPECT_LE(effect.thrust_ratio(-1.0), GroundEffect::kMaxRatio);
  EXPECT_EQ(effect.thrust_ratio(effect.reach_m()), 1.0);
  EXPECT_EQ(effect.thrust_ratio(0.3, -0.5), 1.0);  // blowing away from the ground
  EXPECT_EQ(GroundEffect(GroundEffectModel::kNone, 0.19, 0.31, 2.0).thrust_ratio(0.2), 1.0);
  // Falls with height without a step.
  double before = effect.thrust_ratio(0.1);
  for (double z = 0.1; z < 4.0; z += 1e-5) {
    const double now = effect.thrust_ratio(z);
    EXPECT_LE(now, before + 1e-12);
    EXPECT_LT(before - now, 1e-4);  // 10 per metre
    before = now;
  }
}

}  // namespace
}  // namespace vinerow::vehicles::ground_effect_test
