#pragma once
/// Searches of rrt_quartile on hand-made grids, and what every way found must keep.

#include <gtest/gtest.h>

#include <cmath>

#include "controllers/planning/search/rrt_quartile.h"
#include "engine/math/angles.h"
#include "tests/controllers/planning/search/hand_grids.h"

namespace vinerow::quartile_runs {

using hand_grids::rover_outline_B;

inline constexpr double kFourWheel_per_m = 0.566;  // 23 deg on both axles, base 1.5 m
inline const double kTwoWheel_per_m =
    std::tan(kPi / 6.0) / 1.5;  // paper A: +-pi/6 on the front axle
inline constexpr double kMargin_m = 0.05;

/// A grid with everything that refers to it.
struct Site {
  explicit Site(OccupancyGrid g, double margin_m = kMargin_m)
      : grid(std::move(g)), field(grid), footprint(field, rover_outline_B(), margin_m) {}
  OccupancyGrid grid;
  controllers::DistanceField field;
  controllers::Footprint footprint;
};

struct Found {
  controllers::SearchReport report;
  Result<std::vector<controllers::PathSegment>> pieces = Failure{};
};

inline Found find(const Site& site, const controllers::Pose2& from, const controllers::Pose2& to,
                  const controllers::RrtQuartileParams& params, std::uint64_t seed = 1,
                  int problem = 1) {
  PartContext context;
  context.vehicle = "rover";
  context.part = "rover.planner";
  context.seed = seed;
  controllers::RrtQuartile search(params, context);
  Found run;
  run.pieces = search.find(from, to, site.footprint, problem, run.report);
  return run;
}

inline controllers::RrtQuartileParams make_params(double curvature_per_m = kFourWheel_per_m) {
  controllers::RrtQuartileParams params;
  params.tree.curvature_per_m = curvature_per_m;
  return params;
}

/// Starts and ends exactly, is continuous, turns no tighter than allowed, touches nothing.
inline void expect_drivable(const Site& site, const controllers::Pose2& from,
                            const controllers::Pose2& to,
                            const std::vector<controllers::PathSegment>& pieces,
                            double curvature_per_m) {
  ASSERT_FALSE(pieces.empty());
  controllers::Pose2 at = from;
  for (const controllers::PathSegment& piece : pieces) {
    EXPECT_LT((piece.start.p - at.p).norm(), 1e-9);
    EXPECT_NEAR(wrap_angle(piece.start.yaw_rad - at.yaw_rad), 0.0, 1e-9);
    EXPECT_GT(piece.length_m, 0.0);
    EXPECT_LE(std::abs(piece.curvature_per_m), curvature_per_m * (1.0 + 1e-12));
    EXPECT_EQ(piece.kind, PathKind::kTurn);
    at = piece.end();
  }
  EXPECT_LT((at.p - to.p).norm(), 1e-6);
  EXPECT_NEAR(wrap_angle(at.yaw_rad - to.yaw_rad), 0.0, 1e-6);
  EXPECT_FALSE(hand_grids::path_touches(site.grid, rover_outline_B(), pieces));
}

}  // namespace vinerow::quartile_runs
