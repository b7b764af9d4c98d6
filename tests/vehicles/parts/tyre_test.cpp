#include "vehicles/parts/tyre.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/core/error.h"

namespace vinerow::vehicles::tyre_test {
namespace {

constexpr double kDt = 1e-3;
constexpr double kRadius = 0.2;
constexpr double kLoad = 450.0;

/// Force after `time_s` at constant velocities, from an undeflected tyre.
Eigen::Vector2d settle(const Tyre& tyre, const Soil& soil, double v_x, double v_y, double spin,
                       double time_s = 3.0, double dt = kDt) {
  TyreState state;
  Eigen::Vector2d force = {0, 0};
  for (int i = 0; i < static_cast<int>(std::lround(time_s / dt)); ++i) {
    const TyreStep step = tyre.begin(state, {v_x, v_y}, spin, kLoad, soil, dt);
    force = tyre.finish(step, spin, dt, state);
  }
  return force;
}

TEST(Tyre, PureLongitudinalSlipEqualsClosedForm) {
  const Tyre tyre(TyreParams{}, kRadius);
  const Soil soil;
  for (const double slip : {-0.3, -0.05, -0.01, 0.01, 0.05, 0.1, 0.2, 0.5}) {
    const double spin = 5.0, v_roll = spin * kRadius, v_x = v_roll * (1.0 - slip);
    // Wismer-Luth with the friction of this sliding speed, written out again here.
    const double speed = std::abs(slip) * v_roll;
    const double mu = 0.65 + 0.10 * std::exp(-speed * speed);
    const double expected = kLoad * mu * (1.0 - std::exp(-15.0 * std::abs(slip) / mu));
    // The state converges geometrically; after 3 s only round-off is left.
    EXPECT_NEAR(settle(tyre, soil, v_x, 0.0, spin).x(), std::copysign(expected, slip), 1e-9 * kLoad)
        << "slip " << slip;
  }
}

TEST(Tyre, PureSideSlipEqualsClosedForm) {
  const Tyre tyre(TyreParams{}, kRadius);
  const Soil soil;
  const double spin = 5.0, v_roll = spin * kRadius;
  for (const double angle : {0.01, 0.05, 0.2, 0.6}) {
    const double v_y = v_roll * std::tan(angle);
    const double mu = 0.65 + 0.10 * std::exp(-v_y * v_y);
    const double expected = kLoad * mu * (1.0 - std::exp(-10.0 * std::tan(angle) / mu));
    const Eigen::Vector2d force = settle(tyre, soil, v_roll, v_y, spin);
    EXPECT_NEAR(force.y(), -expected, 1e-9 * kLoad) << "angle " << angle;
    EXPECT_NEAR(force.x(), 0.0, 1e-9 * kLoad);
  }
}

// Lateral friction mu_y = ratio mu: the curve saturates at its own friction, N mu_y (1 - exp(-c
// sigma / mu_y)), and what pulls forward keeps mu.
TEST(Tyre, SideSlipOfATyreThatGripsLessSidewaysEqualsClosedForm) {
  for (const double ratio : {0.5, 1.4}) {
    const Tyre tyre(TyreParams{.lateral_friction_ratio = ratio}, kRadius);
    const Soil soil;
    const double spin = 5.0, v_roll = spin * kRadius;
    for (const double angle : {0.01, 0.05, 0.2, 0.6}) {
      const double v_y = v_roll * std::tan(angle);
      const double mu_y = ratio * (0.65 + 0.10 * std::exp(-v_y * v_y));
      const double expected = kLoad * mu_y * (1.0 - std::exp(-10.0 * std::tan(angle) / mu_y));
      const Eigen::Vector2d force = settle(tyre, soil, v_roll, v_y, spin);
      EXPECT_NEAR(force.y(), -expected, 1e-9 * kLoad) << "ratio " << ratio << ", angle " << angle;
    }
    const double mu = 0.65 + 0.10 * std::exp(-0.01);
    EXPECT_NEAR(settle(tyre, soil, 0.9 * v_roll, 0.0, spin).x(),
                kLoad * mu * (1.0 - std::exp(-15.0 * 0.1 / mu)), 1e-9 * kLoad);
  }
}

// Full sliding at 45 degrees: the force lies on the ellipse of semi-axes mu and ratio mu. Each
// bristle is stretched until v_s_i = Lambda_i xi_i, so F_i = -mu_i^2 v_i / |(mu_x v_x, mu_y v_y)|.
TEST(Tyre, ALockedWheelSlidesOnItsFrictionEllipse) {
  const double ratio = 0.6;
  const Tyre tyre(TyreParams{.lateral_friction_ratio = ratio}, kRadius);
  const Eigen::Vector2d force = settle(tyre, Soil{}, 3.0, 3.0, 0.0);
  const double mu_x = 0.65, mu_y = ratio * 0.65;  // exp(-18) of Stribeck is left
  const double size = std::hypot(mu_x * 3.0, mu_y * 3.0);
  EXPECT_NEAR(force.x(), -kLoad * mu_x * mu_x * 3.0 / size, 1e-6 * kLoad);
  EXPECT_NEAR(force.y(), -kLoad * mu_y * mu_y * 3.0 / size, 1e-6 * kLoad);
}

TEST(Tyre, SmallSlipForceBuildsUpOverTheRelaxationLength) {
  // Linear range: F(t) = F_end (1 - exp(-V t / L)).
  const Tyre tyre(TyreParams{.damping_time_s = 0.0}, kRadius);
  const double spin = 5.0, v = spin * kRadius, length = tyre.params().relaxation_length_m;
  const double end = settle(tyre, Soil{}, v, 1e-5, spin).y();
  for (const double share : {0.5, 1.0, 2.0}) {
    const double now = settle(tyre, Soil{}, v, 1e-5, spin, share * length / v, 1e-4).y();
    // First-order integration at V dt / L = 1/1200.
    EXPECT_NEAR(now / end, 1.0 - std::exp(-share), 1e-3);
  }
}

TEST(Tyre, FullSlidingOpposesTheSlidingVelocity) {
  const Tyre tyre(TyreParams{}, kRadius);
  // Locked wheel, fast sliding: friction has fallen to the sliding value.
  const Eigen::Vector2d force = settle(tyre, Soil{}, 4.0, 3.0, 0.0);
  EXPECT_NEAR(force.x(), -0.8 * 0.65 * kLoad, 1e-6 * kLoad);  // exp(-25) of Stribeck is left
  EXPECT_NEAR(force.y(), -0.6 * 0.65 * kLoad, 1e-6 * kLoad);
}

TEST(Tyre, ForceIsOddInTheVelocities) {
  const Tyre tyre(TyreParams{}, kRadius);
  const Eigen::Vector2d plus = settle(tyre, Soil{}, 1.0, 0.2, 6.0, 0.1);
  const Eigen::Vector2d minus = settle(tyre, Soil{}, -1.0, -0.2, -6.0, 0.1);
  EXPECT_EQ(plus.x(), -minus.x());
  EXPECT_EQ(plus.y(), -minus.y());
}

TEST(Tyre, NeverLeavesTheFrictionEllipse) {
  TyreParams params;
  params.lateral_friction_ratio = 0.7;
  const Tyre tyre(params, kRadius);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> velocity(-3.0, 3.0);
  Soil soil;
  TyreState state;
  double largest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector2d v(velocity(random), velocity(random));
    const double spin = 10.0 * velocity(random);
    const TyreStep step = tyre.begin(state, v, spin, kLoad, soil, kDt);
    const Eigen::Vector2d force = tyre.finish(step, spin, kDt, state);
    const double ratio = std::hypot(force.x() / 0.75, force.y() / (0.75 * 0.7)) / kLoad;
    largest = std::max(largest, ratio);
  }
  EXPECT_LE(largest, 1.0 + 1e-12);  // round-off of the scaling
  EXPECT_GT(largest, 0.9);          // the inputs do reach the limit
}

TEST(Tyre, AtStandstillItIsADampedSpring) {
  // A 45 kg share of a rover pushed by a constant force below the limit comes to rest.
  const Tyre tyre(TyreParams{}, kRadius);
  const Soil soil;
  TyreState state;
  double x = 0.0, v = 0.0;
  const double push = 0.4 * kLoad, mass = kLoad / 9.80665;
  double x_at_2s = 0.0;
  for (int i = 0; i < 60000; ++i) {
    const TyreStep step = tyre.begin(state, {v, 0.0}, 0.0, kLoad, soil, kDt);
    const double force = tyre.finish(step, 0.0, kDt, state).x();
    v += (push + force) / mass * kDt;
    x += v * kDt;
    if (i == 2000) x_at_2s = x;
  }
  EXPECT_NEAR(v, 0.0, 1e-12);
  EXPECT_NEAR(x, x_at_2s, 1e-7);
  // xi = F / (N c), deflection at least L xi; plastic slip before rest makes it somewhat more.
  const double elastic = 0.4 / 15.0 * tyre.params().relaxation_length_m;
  EXPECT_GE(x, elastic * 0.999);
  EXPECT_LE(x, 3.0 * elastic);
}

TEST(Tyre, ForceIsLinearInTheNewSpinUntilTheLimit) {
  const Tyre tyre(TyreParams{}, kRadius);
  TyreState start;
  start.xi = {0.01, 0.005};
  const TyreStep step = tyre.begin(start, {1.0, 0.02}, 5.0, kLoad, Soil{}, kDt);
  for (const double spin : {4.99, 5.0, 5.02}) {
    TyreState state = start;
    const double force = tyre.finish(step, spin, kDt, state).x();
    EXPECT_NEAR(force, step.fx0_N + step.fx1_Ns * spin, 1e-9 * kLoad);
  }
}

TEST(TyreParams, RejectsBadValuesByName) {
  TyreParams params;
  params.relaxation_length_m = 0.0;
  try {
    params.validate("rover.wheel_fl");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "rover.wheel_fl: relaxation_length_m = 0 m, must be > 0 m");
  }
}

}  // namespace
}  // namespace vinerow::vehicles::tyre_test
