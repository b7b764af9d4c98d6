#include "vehicles/parts/rotor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"

namespace vinerow::vehicles::rotor_test {
namespace {

/// Means of w, w^2, w^3 over a step by Simpson's rule on the exponential.
SpeedCourse by_quadrature(double from, double wanted, double lag, double dt) {
  constexpr int kParts = 2000;
  double sums[3] = {0, 0, 0};
  for (int i = 0; i <= kParts; ++i) {
    const double w = wanted + (from - wanted) * std::exp(-dt * i / kParts / lag);
    const double weight = (i == 0 || i == kParts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) / (3.0 * kParts);
    sums[0] += weight * w, sums[1] += weight * w * w, sums[2] += weight * w * w * w;
  }
  return {wanted + (from - wanted) * std::exp(-dt / lag), sums[0], sums[1], sums[2]};
}

TEST(SpeedLag, IsExactForAnyStep) {
  for (const double dt : {1e-4, 1e-3, 0.02, 0.3}) {
    for (const auto& [from, wanted] : {std::pair{100.0, 400.0}, std::pair{500.0, 0.0}}) {
      const SpeedCourse course = SpeedLag(0.05, dt).run(from, wanted);
      const SpeedCourse expected = by_quadrature(from, wanted, 0.05, dt);
      EXPECT_NEAR(course.end_radps, expected.end_radps, 1e-9);
      EXPECT_NEAR(course.mean_radps, expected.mean_radps, 1e-9);
      EXPECT_NEAR(course.mean_square, expected.mean_square, 1e-6);
      EXPECT_NEAR(course.mean_cube, expected.mean_cube, 1e-3);
    }
  }
}

TEST(SpeedLag, AStepResponseReaches63PercentAfterTheLag) {
  const SpeedLag lag(0.05, 1e-3);
  double w = 0.0;
  for (int i = 0; i < 50; ++i) w = lag.run(w, 100.0).end_radps;
  EXPECT_NEAR(w, 100.0 * (1.0 - std::exp(-1.0)), 1e-9);
}

TEST(SpeedLag, WithoutLagItIsThereAtOnce) {
  const SpeedCourse course = SpeedLag(0.0, 1e-3).run(100.0, 300.0);
  EXPECT_EQ(course.end_radps, 300.0);
  EXPECT_EQ(course.mean_square, 9e4);
}

TEST(RotorLags, RisesAndFallsEachByItsOwn) {
  RotorParams rotor;
  rotor.rise_lag_s = 0.03;
  rotor.fall_lag_s = 0.08;
  const RotorLags lags(rotor, 0.01);
  EXPECT_NEAR(lags.run(0.0, 100.0).end_radps, 100.0 * (1.0 - std::exp(-1.0 / 3.0)), 1e-9);
  EXPECT_NEAR(lags.run(100.0, 0.0).end_radps, 100.0 * std::exp(-1.0 / 8.0), 1e-9);
}

TEST(RotorAir, PushesWithTheAirInProportionToTheSpeed) {
  const RotorAir air{2e-4, 1e-3};
  EXPECT_LT((air.force_B(300.0, {1.0, -2.0, 0.5}) - Eigen::Vector3d(0.06, -0.12, 0.15)).norm(), 1e-15);
  EXPECT_EQ(air.force_B(0.0, {1.0, -2.0, 0.5}), Eigen::Vector3d::Zero());
}

TEST(RotorParams, RefusesAnImpossibleRotor) {
  RotorParams rotor;
  rotor.rise_lag_s = -0.1;
  try {
    rotor.validate("drone");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "drone: rotor_rise_lag_s = -0.1 s, must be >= 0 s and <= 10 s");
  }
}

}  // namespace
}  // namespace vinerow::vehicles::rotor_test
