// Rounded curves, time laws and turns on the spot against closed forms.

#include "controllers/trajectory/smooth_run.h"

#include <gtest/gtest.h>

#include <cmath>

#include "controllers/parts/paths/box_filter.h"
#include "controllers/parts/paths/path_pieces.h"
#include "controllers/trajectory/landing_watch.h"
#include "controllers/trajectory/time_law.h"
#include "controllers/trajectory/yaw_move.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::test::smooth_run_test {
namespace {

using Vec3 = Eigen::Vector3d;
constexpr double kRadius_m = 1.77;
constexpr double kBlend_m = 0.8;

/// 10 m straight along x, half a turn to the left, 10 m back.
controllers::CurveRun make_hairpin() {
  const controllers::Pose2 start;
  const controllers::PathSegment out{start, 10.0, 0.0, PathKind::kLeg, 0, 0.0};
  const controllers::PathSegment arc{
      out.end(), kPi * kRadius_m, 1.0 / kRadius_m, PathKind::kTurn, -1, 0.0};
  const controllers::PathSegment back{arc.end(), 10.0, 0.0, PathKind::kLeg, 1, 0.0};
  const std::vector<controllers::CurveRun> runs =
      controllers::make_curve_runs(controllers::make_planned_path({out, arc, back}, 0.25), 0.3);
  EXPECT_EQ(runs.size(), 1u);
  return runs.front();
}

TEST(BoxFilter, KeepsStraightLinesAndEnds) {
  std::vector<double> line;
  for (int i = 0; i < 30; ++i) line.push_back(3.0 - 0.7 * i);
  const std::vector<double> smooth =
      controllers::smooth_box(line, 4, controllers::Beyond::kTurnedAbout);
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(smooth[i], line[i], 1e-12);
  const std::vector<double> step = {0, 0, 0, 0, 1, 1, 1, 1};
  const std::vector<double> mean = controllers::smooth_box(step, 1, controllers::Beyond::kConstant);
  EXPECT_NEAR(mean[3], 0.25, 1e-12);
  EXPECT_NEAR(mean[4], 0.75, 1e-12);
  EXPECT_EQ(mean[2], 0.0);
  EXPECT_EQ(mean[0], 0.0);
  EXPECT_EQ(controllers::dilate(step, 2)[2], 1.0);
  EXPECT_EQ(controllers::dilate(step, 2)[1], 0.0);
}

TEST(SmoothRun, StraightsStayAndArcsMoveInwardsAsTold) {
  const controllers::SmoothRun run(make_hairpin(), kBlend_m);
  EXPECT_NEAR(run.length_m(), 20.0 + kPi * kRadius_m, 1e-9);
  for (const double at_m : {0.0, 0.013, 2.0, 8.7}) {
    EXPECT_NEAR((run.at(at_m).p_W - Vec3(at_m, 0, 0)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(run.at(at_m).yaw_per_m, 0.0, 1e-9);
  }
  const double inwards_m = kBlend_m * kBlend_m * (1.0 + 1.0 / 4.0) / (24.0 * kRadius_m);
  const Vec3 centre(10.0, kRadius_m, 0.0);
  for (double at_m = 11.0; at_m < 14.5; at_m += 0.33) {
    EXPECT_NEAR((run.at(at_m).p_W - centre).norm(), kRadius_m - inwards_m, 1e-3);
  }
  EXPECT_NEAR((run.at(1e9).p_W - Vec3(0.0, 2.0 * kRadius_m, 0.0)).norm(), 0.0, 1e-6);
  EXPECT_NEAR(run.end_yaw_rad(), kPi, 1e-9);
  EXPECT_EQ(run.kind_at(5.0), PathKind::kLeg);
  EXPECT_EQ(run.kind_at(12.0), PathKind::kTurn);
}

TEST(SmoothRun, CurvatureRampsOverTheBlend) {
  const controllers::SmoothRun run(make_hairpin(), kBlend_m);
  // Half way up where the arc begins, linear within the blend, full after it.
  EXPECT_NEAR(run.at(10.0).yaw_per_m, 0.5 / kRadius_m, 0.01);
  EXPECT_NEAR(run.at(10.2).yaw_per_m, 0.75 / kRadius_m, 0.015);
  EXPECT_NEAR(run.at(9.35).yaw_per_m, 0.0, 1e-3);
  EXPECT_NEAR(run.at(10.7).yaw_per_m, 1.0 / kRadius_m, 0.01);
}

TEST(TimeLaw, AFlightOfYearsIsRefusedBeforeItIsSampled) {
  const controllers::SmoothRun run(make_hairpin(), kBlend_m);
  controllers::TrajectoryLimits limits;
  limits.lateral_acceleration_mps2 = 1e-308;
  try {
    const controllers::TimeLaw law(run, limits, 1e9);
    FAIL() << "not refused";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("at most 56 h are planned: raise its speeds"),
              std::string::npos)
        << error.what();
  }
}

TEST(TimeLaw, FliesAStraightAsFastAsItMay) {
  const controllers::PathSegment straight{controllers::Pose2{}, 100.0, 0.0, PathKind::kLeg, 0, 0.0};
  const auto runs =
      controllers::make_curve_runs(controllers::make_planned_path({straight}, 0.5), 0.3);
  const controllers::SmoothRun run(runs.front(), kBlend_m);
  const controllers::TrajectoryLimits limits;
  const controllers::TimeLaw law(run, limits, 1e9);
  // v / a to speed up, the same to slow down, and what the easing adds.
  const double min_s = 100.0 / 3.0 + 3.0 / limits.acceleration_mps2;
  EXPECT_GT(law.duration_s(), min_s);
  EXPECT_LT(law.duration_s(), min_s + limits.ease_s + 0.3);
  EXPECT_NEAR(law.at(law.duration_s() / 2).value, 50.0, 0.05);
  EXPECT_NEAR(law.at(law.duration_s() / 2).first, 3.0, 1e-9);
  EXPECT_EQ(law.at(0.0).value, 0.0);
  EXPECT_NEAR(law.at(1e9).value, 100.0, 1e-9);
  EXPECT_NEAR(law.at(law.time_of(37.0)).value, 37.0, 1e-4);
  double before = 0.0;
  for (double t = 0.0; t < law.duration_s(); t += 0.01) {
    const auto at = law.at(t);
    ASSERT_GE(at.first, -1e-12);
    ASSERT_LE(std::abs(at.second), limits.acceleration_mps2);
    ASSERT_LT(std::abs(at.second - before), 0.01 * 2.2 / limits.ease_s);  // sets in over ease_s
    before = at.second;
  }
}

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

}  // namespace
}  // namespace vinerow::test::smooth_run_test
