// Touchdown: which motion counts, and for how long.

#include "controllers/trajectory/landing_watch.h"

#include <gtest/gtest.h>

namespace vinerow::test::landing_watch_test {
namespace {

using controllers::LandingWatch;

TEST(LandingWatch, FeelsTheGroundOnlyNearTheEndAndOnlyWhileSinking) {
  constexpr double kTick_s = 0.05;
  controllers::LandingWatch watch;
  const auto ticks_until = [&](controllers::LandingWatch::Observation observation) {
    watch = controllers::LandingWatch(controllers::LandingWatch::Params{});
    int ticks = 0;
    while (ticks < 100 && !watch.has_landed(observation, kTick_s)) ++ticks;
    return ticks;
  };
  EXPECT_NEAR(ticks_until({-0.3, 0.0, 0.1, false}), 9, 1);  // half a second
  EXPECT_EQ(ticks_until({-0.3, -0.3, 0.1, false}), 100);    // sinks
  EXPECT_EQ(ticks_until({0.0, 0.0, 0.1, false}), 100);      // is not to sink
  EXPECT_EQ(ticks_until({-0.3, 0.0, 3.0, false}), 100);     // high above
  EXPECT_NEAR(ticks_until({0.0, 0.0, 3.0, true}), 39, 1);   // the plan is over for 2 s
}

TEST(LandingWatch, AQuarterOfTheLandingSpeedIsRest) {
  const auto lands = [](double vertical_mps) {
    LandingWatch watch;
    bool landed = false;
    for (int k = 0; k < 20; ++k) landed = watch.has_landed({-0.3, vertical_mps, 0.1, false}, 0.05);
    return landed;
  };
  EXPECT_TRUE(lands(-0.074));
  EXPECT_FALSE(lands(-0.076));
  EXPECT_TRUE(lands(0.29));
  EXPECT_FALSE(lands(0.31));
}

TEST(LandingWatch, AMotionStartsTheCountAgain) {
  constexpr double kDt_s = 0.125;  // exact: four of them are half a second
  LandingWatch watch;
  const LandingWatch::Observation rest{-0.3, 0.0, 0.1, false}, sinking{-0.3, -0.3, 0.1, false};
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(watch.has_landed(rest, kDt_s));
  EXPECT_FALSE(watch.has_landed(sinking, kDt_s));
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(watch.has_landed(rest, kDt_s));
  EXPECT_TRUE(watch.has_landed(rest, kDt_s));
}

}  // namespace
}  // namespace vinerow::test::landing_watch_test
