#include "controllers/planning/survey/survey_lanes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "engine/core/error.h"
#include "engine/io/geo/area_file.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"

namespace vinerow::test::survey_lanes_test {
namespace {

using Eigen::Vector2d;

const Polygon kSquare = {{0, 0}, {100, 0}, {100, 100}, {0, 100}};
/// An arrow head: its notch reaches to the middle.
const Polygon kArrow = {{0, 0}, {200, 100}, {0, 200}, {80, 100}};

TEST(SurveyLanes, RunAlongTheDirectionOfLeastWidth) {
  // A strip 400 m by 90 m, turned by 30 degrees: brute force over directions agrees.
  Polygon strip;
  for (const Vector2d& p :
       {Vector2d(0, 0), Vector2d(400, 20), Vector2d(380, 90), Vector2d(-9, 80)}) {
    const double c = std::cos(kPi / 6), s = std::sin(kPi / 6);
    strip.emplace_back(c * p.x() - s * p.y(), s * p.x() + c * p.y());
  }
  const auto width_of = [&](double yaw) {
    const controllers::LaneFrame frame{yaw};
    double low = 1e9, high = -1e9;
    for (const Vector2d& p : strip) {
      low = std::min(low, frame.to_lane(p).y());
      high = std::max(high, frame.to_lane(p).y());
    }
    return high - low;
  };
  double min_width = 1e9;
  for (int i = 0; i < 1800; ++i) min_width = std::min(min_width, width_of(rad_from_deg(0.1 * i)));
  EXPECT_LE(width_of(controllers::choose_lane_yaw_rad(strip)), min_width);
  EXPECT_GT(width_of(controllers::choose_lane_yaw_rad(strip)), min_width - 1.0);
}

TEST(SurveyLanes, CountAndSpacingFollowThePaper) {
  controllers::LaneNeeds needs;
  needs.spacing_m = 45.0;
  needs.end_margin = 0.0;
  // 405 m wide: ceil(405 / 45) + 1 = 10 lanes of 260 m (paper A's reference).
  const Polygon parcel = {{0, 0}, {260, 0}, {260, 405}, {0, 405}};
  const auto lanes = controllers::cut_lanes(parcel, {0.0}, needs);
  ASSERT_EQ(lanes.size(), 10u);
  EXPECT_NEAR(lanes[1].across_m - lanes[0].across_m, 45.0, 1e-9);
  for (const controllers::SurveyLane& lane : lanes) {
    ASSERT_EQ(lane.pieces.size(), 1u);
    EXPECT_NEAR(lane.high_m() - lane.low_m(), 260.0, 1e-9);
  }
  needs.spacing_m = 44.9;
  EXPECT_EQ(controllers::cut_lanes(parcel, {0.0}, needs).size(), 11u);
  needs.edge_margin = -0.5;  // pictures end on the edges
  const auto fewer = controllers::cut_lanes(parcel, {0.0}, needs);
  EXPECT_NEAR(fewer.front().across_m, 0.5 * 133.0, 1e-9);
  EXPECT_NEAR(fewer.back().across_m, 405.0 - 0.5 * 133.0, 1e-9);
  // Narrower than a picture: one lane along the middle.
  const auto one = controllers::cut_lanes({{0, 0}, {260, 0}, {260, 100}, {0, 100}}, {0.0}, needs);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_NEAR(one[0].across_m, 50.0, 1e-9);
}

/// Every place of a polygon lies on the stretch of the two lanes beside it, margin included.
TEST(SurveyLanes, EveryPlaceIsSeenFromTheLanesBesideIt) {
  controllers::LaneNeeds needs;
  needs.spacing_m = 20.0;
  needs.footprint_width_m = 60.0;
  needs.footprint_length_m = 30.0;
  for (const Polygon& polygon :
       {kSquare, kArrow, Polygon{{0, 0}, {150, 40}, {120, 90}, {10, 60}}}) {
    for (const double yaw : {0.0, 0.4, 1.2, -0.9}) {
      const controllers::LaneFrame frame{yaw};
      const auto lanes = controllers::cut_lanes(polygon, frame, needs);
      const double spacing = lanes[1].across_m - lanes[0].across_m;
      for (double x = 0.5; x < 200.0; x += 3.0) {
        for (double y = 0.5; y < 200.0; y += 3.0) {
          if (!contains(polygon, {x, y})) continue;
          const Vector2d at = frame.to_lane({x, y});
          int covering = 0, adjacent = 0;
          for (const controllers::SurveyLane& lane : lanes) {
            if (std::abs(lane.across_m - at.y()) > spacing) continue;
            ++adjacent;
            for (const controllers::LaneSegment& piece : lane.pieces) {
              covering +=
                  at.x() >= piece.from_m + 15.0 - 1e-6 && at.x() <= piece.to_m - 15.0 + 1e-6;
            }
          }
          ASSERT_GE(adjacent, 2) << x << " " << y << " " << yaw;
          ASSERT_EQ(covering, adjacent) << x << " " << y << " " << yaw;
        }
      }
    }
  }
}

TEST(SurveyLanes, SwitchTheCameraOffAboveLongNotches) {
  controllers::LaneNeeds needs;
  needs.spacing_m = 20.0;
  needs.footprint_width_m = 60.0;
  needs.footprint_length_m = 20.0;
  // A U: arms 50 m wide at both ends, 200 m between them.
  const Polygon u = {{0, 0},    {300, 0}, {300, 200}, {250, 200},
                     {250, 60}, {50, 60}, {50, 200},  {0, 200}};
  const auto lanes = controllers::cut_lanes(u, {0.0}, needs);
  EXPECT_EQ(lanes.front().pieces.size(), 1u);
  ASSERT_EQ(lanes.back().pieces.size(), 2u);
  EXPECT_NEAR(lanes.back().pieces[0].to_m, 60.0, 1e-9);
  EXPECT_NEAR(lanes.back().pieces[1].from_m, 240.0, 1e-9);
}

}  // namespace
}  // namespace vinerow::test::survey_lanes_test
