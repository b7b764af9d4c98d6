#include "controllers/parts/rotorcraft/lay_down.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vinerow::test::lay_down_test {
namespace {

constexpr double kInertia_kgm2 = 0.12, kWeight_N = 20.0, kDt_s = 1e-4;
constexpr double kLay_radps = 0.35;  // the rate at which it should come down

controllers::Wrench holding(const Eigen::Vector3d& torque_B) {
  return {15.0, torque_B};
}

/// A body that turns about its foot under a steady torque of its weight.
struct Body {
  Eigen::Vector3d push_B, rates_B = Eigen::Vector3d::Zero();
  controllers::LayDown lay_down{kInertia_kgm2, kWeight_N};
  explicit Body(const Eigen::Vector3d& push) : push_B(push) { lay_down.start(holding(-push)); }
  controllers::Wrench advance() {
    const controllers::Wrench wrench = lay_down.advance(rates_B, kDt_s);
    rates_B += kDt_s / kInertia_kgm2 * (push_B + wrench.torque_B);
    return wrench;
  }
};

TEST(LayDown, ComesDownLikeADampedOscillatorsStep) {
  // Held in balance, I w' = G + S - D w with S' = -K (w - w_lay): the step of an oscillator with
  // omega^2 = K / I = 30 / s2 and 2 zeta omega = D / I = 4.5 / s, whichever way the slope leads.
  const double omega = std::sqrt(30.0), zeta = 4.5 / (2.0 * omega);
  const double damped = omega * std::sqrt(1.0 - zeta * zeta);
  for (const double angle_travelled_rad : {0.0, 0.7, 2.5, -1.2}) {
    const Eigen::Vector3d direction_B(std::cos(angle_travelled_rad), std::sin(angle_travelled_rad),
                                      0.0);
    Body body(3.0 * direction_B);
    for (double t = kDt_s; t < 0.8; t += kDt_s) {
      body.advance();
      const double decay = std::exp(-zeta * omega * t);
      const double swing = std::cos(damped * t) + zeta * omega / damped * std::sin(damped * t);
      const double rate = kLay_radps * (1.0 - decay * swing);
      ASSERT_NEAR(body.rates_B.dot(direction_B), rate, 0.002) << t;
      ASSERT_LT((body.rates_B - body.rates_B.dot(direction_B) * direction_B).norm(), 1e-9);
    }
  }
}

TEST(LayDown, FallsSilentOnAVehicleThatLies) {
  // No longer turning it lets go of S within S / (K w_lay), and of the thrust within half a second.
  controllers::LayDown lay_down(kInertia_kgm2, kWeight_N);
  const Eigen::Vector3d held_B(1.2, -0.9, 0.0);
  lay_down.start(holding(held_B));
  const double silent_s = held_B.norm() / (30.0 * kInertia_kgm2 * kLay_radps);
  controllers::Wrench wrench;
  for (double t = kDt_s; t < silent_s + 0.01; t += kDt_s) {
    wrench = lay_down.advance(Eigen::Vector3d::Zero(), kDt_s);
    const double left = std::max(0.0, 1.0 - t / silent_s);
    ASSERT_NEAR((wrench.torque_B - left * held_B).norm(), 0.0, 1e-3) << t;
    ASSERT_NEAR(wrench.thrust_N, 15.0 * std::max(0.0, 1.0 - t / 0.5), 1e-2) << t;
  }
  EXPECT_EQ(wrench.torque_B, Eigen::Vector3d::Zero());
  EXPECT_EQ(wrench.thrust_N, 0.0);
}

TEST(LayDown, LeavesYawToTheFeet) {
  controllers::LayDown lay_down(kInertia_kgm2, kWeight_N);
  lay_down.start(holding({0.5, 0.0, 0.8}));
  EXPECT_EQ(lay_down.advance({0.0, 0.0, 2.0}, kDt_s).torque_B.z(), 0.0);
}

TEST(LayDown, NeverLiftsMoreThanHalfTheWeightOnceItsThrustIsGone) {
  controllers::LayDown lay_down(kInertia_kgm2, kWeight_N);
  lay_down.start(holding(Eigen::Vector3d::UnitX()));
  EXPECT_EQ(lay_down.max_thrust_N(), 15.0);
  for (double t = 0.0; t < 0.6; t += kDt_s) lay_down.advance(Eigen::Vector3d::Zero(), kDt_s);
  EXPECT_EQ(lay_down.max_thrust_N(), 0.5 * kWeight_N);
}

TEST(LayDown, ForgetsWhatTheRotorsCannotHold) {
  controllers::LayDown lay_down(kInertia_kgm2, kWeight_N);
  lay_down.start(holding({2.0, 0.0, 0.0}));
  lay_down.limit(0.25);
  const double less_Nm = 30.0 * kInertia_kgm2 * kLay_radps * kDt_s;
  EXPECT_NEAR(lay_down.advance(Eigen::Vector3d::Zero(), kDt_s).torque_B.x(), 0.5 - less_Nm, 1e-12);
}

}  // namespace
}  // namespace vinerow::test::lay_down_test
