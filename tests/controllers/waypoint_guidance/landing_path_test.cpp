/// The way down over ground that is not level.

#include "controllers/waypoint_guidance/landing_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::test::landing_path_test {
namespace {

constexpr double kLift_m = 0.05, kFlare_m = 1.0, kTouchdown_m = 7.05;

controllers::LandingSlope slope() {
  return {kTouchdown_m, rad_from_deg(5.0), kFlare_m};
}

/// @param height_m  of the ground, by the distance before the place (negative: beyond it)
controllers::LandingPath over(const std::function<double(double)>& height_m) {
  controllers::LandingLine line;
  line.place = {100.0, -40.0};
  line.along = {0.6, 0.8};
  line.length_m = slope().length_m(30.0);
  return {slope(), line,
          [=](const Eigen::Vector2d& p) -> std::optional<double> {
            return height_m((line.place - p).dot(line.along));
          },
          kLift_m};
}

TEST(LandingPath, OnLevelGroundIsTheSlope) {
  const controllers::LandingPath path = over([](double) { return 7.0; });
  for (double to_go_m = 350.0; to_go_m > -20.0; to_go_m -= 0.7) {
    EXPECT_NEAR(path.at(to_go_m).height_m, slope().at(to_go_m).height_m, 0.02) << to_go_m;
    EXPECT_NEAR(path.lying(to_go_m).height_m, kTouchdown_m, 1e-9);
  }
  EXPECT_NEAR(path.rise(), 0.0, 1e-12);
  EXPECT_NEAR(path.steepest_fall(), 0.0, 1e-12);
}

TEST(LandingPath, SinksOntoASlopeAsOntoAPlain) {
  for (const double rise : {0.15, -0.15}) {
    const controllers::LandingPath path =
        over([rise](double to_go_m) { return 7.0 - rise * to_go_m; });
    EXPECT_NEAR(path.rise(), rise, 1e-9);
    EXPECT_NEAR(path.steepest_fall(), std::max(0.0, -rise), 1e-9);
    for (double to_go_m = 20.0; to_go_m > -20.0; to_go_m -= 0.7) {
      const controllers::HeightPoint at = path.at(to_go_m), lying = path.lying(to_go_m);
      const controllers::HeightPoint level = slope().at(to_go_m);
      EXPECT_NEAR(at.height_m - lying.height_m, level.height_m - kTouchdown_m, 0.02) << to_go_m;
      EXPECT_NEAR(at.slope - lying.slope, level.slope, 0.01) << to_go_m;
    }
  }
}

TEST(LandingPath, KeepsClearOfARidgeBeforeTheTouchdown) {
  // Eight metres high, 60 m before: a glide of 5 deg to the touchdown would pass 2.1 m below its
  // top.
  const auto ridge_m = [](double to_go_m) {
    return 7.0 + 8.0 * std::exp(-std::pow((to_go_m - 60.0) / 20.0, 2));
  };
  const controllers::LandingPath path = over(ridge_m);
  EXPECT_LT(slope().at(60.0).height_m, ridge_m(60.0) - 2.0);
  for (double to_go_m = 300.0; to_go_m > 30.0; to_go_m -= 0.7) {
    EXPECT_GT(path.at(to_go_m).height_m - ridge_m(to_go_m) - kLift_m, 0.9 * kFlare_m) << to_go_m;
  }
  EXPECT_GT(path.highest_m(), 7.0 + 8.0);
}

TEST(LandingPath, TakesGroundThatTheMapLacksForThatNearest) {
  controllers::LandingLine line;
  line.length_m = slope().length_m(30.0);
  const controllers::LandingPath path(
      slope(), line,
      [](const Eigen::Vector2d& p) {
        return std::abs(p.x()) < 50.0 ? std::optional(7.0 + 0.05 * p.x()) : std::nullopt;
      },
      kLift_m);
  EXPECT_NEAR(path.lying(200.0).height_m, kTouchdown_m - 2.5, 0.06);
  EXPECT_NEAR(path.lying(-59.0).height_m, kTouchdown_m + 2.5, 0.06);
}

}  // namespace
}  // namespace vinerow::test::landing_path_test
