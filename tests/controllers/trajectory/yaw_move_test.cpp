// Turns on the spot against the polynomial's closed form.

#include "controllers/trajectory/yaw_move.h"

#include <gtest/gtest.h>

namespace vinerow::test::yaw_move_test {
namespace {

TEST(YawMove, TakesTheShortWayWithinBothLimits) {
  const controllers::YawMove move = controllers::make_yaw_move(2.0, 3.0, -3.0, 1.5, 2.5);
  EXPECT_NEAR(move.turn_rad, 2.0 * kPi - 6.0, 1e-12);
  double rate = 0.0, acceleration = 0.0;
  const controllers::YawMove wide = controllers::make_yaw_move(0.0, 0.0, 3.0, 1.5, 2.5);
  for (double t = 0.0; t < wide.duration_s; t += 1e-3) {
    rate = std::max(rate, wide.at(t).rate_radps);
    acceleration =
        std::max(acceleration, (wide.at(t + 1e-3).rate_radps - wide.at(t).rate_radps) / 1e-3);
  }
  EXPECT_LE(rate, 1.5 + 1e-9);
  EXPECT_LE(acceleration, 2.5 + 1e-9);
  EXPECT_TRUE(rate > 1.49 || acceleration > 2.48);
  EXPECT_EQ(wide.at(-1.0).yaw_rad, 0.0);
  EXPECT_NEAR(wide.at(1e9).yaw_rad, 3.0, 1e-12);
}

TEST(YawMove, IsAsFastAsTheLimitThatBinds) {
  // Peak rate 15/8 turn / T in the middle; peak acceleration 10/sqrt(3) turn / T^2 at T (3 - sqrt
  // 3) / 6.
  const controllers::YawMove by_rate = controllers::make_yaw_move(1.0, 0.5, 2.5, 0.4, 100.0);
  EXPECT_NEAR(by_rate.duration_s, 15.0 / 8.0 * 2.0 / 0.4, 1e-12);
  EXPECT_NEAR(by_rate.at(1.0 + 0.5 * by_rate.duration_s).rate_radps, 0.4, 1e-12);

  const controllers::YawMove by_acceleration =
      controllers::make_yaw_move(1.0, 0.5, -1.5, 50.0, 0.3);
  const double expected_s = std::sqrt(10.0 / std::sqrt(3.0) * 2.0 / 0.3);
  EXPECT_NEAR(by_acceleration.duration_s, expected_s, 1e-12);
  const double peak_s = 1.0 + expected_s * (3.0 - std::sqrt(3.0)) / 6.0, h_s = 1e-4;
  EXPECT_NEAR(
      (by_acceleration.at(peak_s + h_s).rate_radps - by_acceleration.at(peak_s - h_s).rate_radps) /
          (2.0 * h_s),
      -0.3, 1e-6);
}

TEST(YawMove, RateIsTheDerivativeOfTheHeading) {
  const controllers::YawMove move = controllers::make_yaw_move(2.0, 1.0, -0.6, 1.5, 2.5);
  for (double t_s = 1.0; t_s < move.end_s() + 1.0; t_s += 0.07) {
    const double h_s = 1e-5;
    EXPECT_NEAR(move.at(t_s).rate_radps,
                (move.at(t_s + h_s).yaw_rad - move.at(t_s - h_s).yaw_rad) / (2.0 * h_s), 1e-7);
  }
  EXPECT_EQ(move.at(1.9).rate_radps, 0.0);
  EXPECT_NEAR(move.at(0.5 * (move.start_s + move.end_s())).yaw_rad, 0.2, 1e-12);
}

TEST(YawMove, NoTurnTakesNoTime) {
  const controllers::YawMove move = controllers::make_yaw_move(2.0, 1.0, 1.0, 1.5, 2.5);
  EXPECT_EQ(move.duration_s, 0.0);
  EXPECT_EQ(move.at(2.0).yaw_rad, 1.0);
  EXPECT_EQ(move.at(2.0).rate_radps, 0.0);
}

}  // namespace
}  // namespace vinerow::test::yaw_move_test
