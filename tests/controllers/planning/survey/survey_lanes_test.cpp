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

std::string fault_of(const Polygon& polygon) {
  return io::find_area_fault(polygon).value_or("none");
}

TEST(SurveyArea, TellsWhichEdgesCross) {
  EXPECT_EQ(fault_of(kSquare), "none");
  EXPECT_EQ(fault_of(kArrow), "none");
  EXPECT_EQ(fault_of({{0, 0}, {100, 100}, {100, 0}, {0, 100}}),
            "its edge from point 1 (0.0, 0.0) to point 2 (100.0, 100.0) crosses its edge from "
            "point 3 (100.0, 0.0) to point 4 (0.0, 100.0)");
  // A corner that touches an edge, an edge on an edge, and a spike.
  EXPECT_NE(fault_of({{0, 0}, {100, 0}, {100, 100}, {50, 0}, {0, 100}}), "none");
  EXPECT_NE(fault_of({{0, 0}, {100, 0}, {100, 50}, {80, 0}, {20, 0}, {0, 50}}), "none");
  EXPECT_NE(fault_of({{0, 0}, {100, 0}, {100, 100}, {100, 160}, {100, 100}, {0, 100}}), "none");
  EXPECT_EQ(fault_of({{0, 0}, {1, 1}}), "it has 2 different points, needs at least 3");
  EXPECT_EQ(fault_of({{0, 0}, {50, 50}, {100, 100}}),
            "its 3 points enclose 0.000 m2, must be at least 1 m2");
  EXPECT_EQ(fault_of({{0, 0}, {100, 0}, {-8e6, 100}}),
            "its points 1 and 3 are 8000 km apart, must be at most 50 km");
  Polygon circle;
  for (int i = 0; i < 5001; ++i) {
    const double angle_rad = 2.0 * 3.141592653589793 * i / 5001;
    circle.emplace_back(100.0 * std::cos(angle_rad), 100.0 * std::sin(angle_rad));
  }
  EXPECT_EQ(fault_of(circle), "it has 5001 points, must have at most 5000: simplify it");
}

TEST(SurveyArea, CleansClosedRings) {
  EXPECT_EQ(without_repeats({{0, 0}, {0, 0}, {9, 0}, {9, 9}, {0, 0}}).size(), 3u);
}

TEST(SurveyArea, WidensEveryEdge) {
  const Polygon wide = widen(kSquare, 10.0);
  EXPECT_NEAR(signed_area_m2(wide), 120.0 * 120.0, 1e-9);
  // Clockwise too, and inwards.
  EXPECT_NEAR(signed_area_m2(
                  widen({kSquare.rbegin(), kSquare.rend()}, -10.0)),
              -80.0 * 80.0, 1e-9);
  // The arrow's sharp tips are cut off; all of it stays inside.
  const Polygon arrow = widen(kArrow, 5.0);
  EXPECT_EQ(fault_of(arrow), "none");
  for (const Vector2d& p : kArrow) EXPECT_TRUE(contains(arrow, p));
  for (const Vector2d& p : arrow) {
    EXPECT_LT((p - kArrow[0]).norm() < 60 ? (p - kArrow[0]).norm() : 0.0, 11.0);
  }
}

TEST(SurveyArea, ReadsGeoJsonAndCsv) {
  const auto folder = std::filesystem::temp_directory_path();
  const GeoOrigin origin{rad_from_deg(44.7), rad_from_deg(8.0), 300.0};
  const LocalFrame frame(origin);
  std::string ring;
  for (const Vector2d& p : {Vector2d(0, 0), Vector2d(100, 0), Vector2d(50, 80), Vector2d(0, 0)}) {
    const Geodetic g = frame.to_geodetic({p.x(), p.y(), 0.0});
    ring += (ring.empty() ? "[" : ",[") + std::to_string(deg_from_rad(g.longitude_rad)) + "," +
            std::to_string(deg_from_rad(g.latitude_rad)) + "]";
  }
  const auto geojson = folder / "vinerow_survey_area.geojson";
  std::ofstream(geojson) << R"({"type":"Polygon","coordinates":[[)" << ring << "]]}";
  const Polygon polygon = io::read_area(geojson, origin);
  ASSERT_EQ(polygon.size(), 3u);
  EXPECT_LT((polygon[2] - Vector2d(50, 80)).norm(), 0.2);  // six digits of a degree

  std::ofstream(geojson) << R"({"type":"Point","coordinates":[8,44]})";
  EXPECT_THROW(io::read_area(geojson, origin), ConfigError);

  const auto csv = folder / "vinerow_survey_area.CSV";
  std::ofstream(csv) << "x,y\n# corners\n0,0\r\n100;0\n 50, 80 \n0,0\n";
  EXPECT_EQ(io::read_area(csv, origin),
            (Polygon{{0, 0}, {100, 0}, {50, 80}}));
  std::ofstream(csv) << "0,0\n1,2,3\n";
  try {
    io::read_area(csv, origin);
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find(":2: '1,2,3' must be two numbers"), std::string::npos);
  }
}

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
  double least = 1e9;
  for (int i = 0; i < 1800; ++i) least = std::min(least, width_of(rad_from_deg(0.1 * i)));
  EXPECT_LE(width_of(controllers::choose_lane_yaw_rad(strip)), least);
  EXPECT_GT(width_of(controllers::choose_lane_yaw_rad(strip)), least - 1.0);
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
          int seen = 0, beside = 0;
          for (const controllers::SurveyLane& lane : lanes) {
            if (std::abs(lane.across_m - at.y()) > spacing) continue;
            ++beside;
            for (const controllers::LaneSegment& piece : lane.pieces) {
              seen += at.x() >= piece.from_m + 15.0 - 1e-6 && at.x() <= piece.to_m - 15.0 + 1e-6;
            }
          }
          ASSERT_GE(beside, 2) << x << " " << y << " " << yaw;
          ASSERT_EQ(seen, beside) << x << " " << y << " " << yaw;
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
