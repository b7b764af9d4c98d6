// Rounded curves against closed forms.

#include "controllers/trajectory/smooth_run.h"

#include <gtest/gtest.h>

#include <cmath>

#include "controllers/parts/paths/box_filter.h"
#include "controllers/parts/paths/path_pieces.h"
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

}  // namespace
}  // namespace vinerow::test::smooth_run_test
