#include "controllers/planning/survey/survey_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "controllers/parts/paths/pose2.h"
#include "engine/math/angles.h"

namespace vinerow::test::survey_plan_test {
namespace {

using Eigen::Vector2d;

controllers::GroundHeight flat() {
  return [](const Vector2d&) { return std::optional<double>(0.0); };
}

/// 30 m of relief over a parcel, as in the paper's terrain: a synthetic hillside with folds across
/// the lanes.
double hills_m(const Vector2d& p) {
  return 0.045 * p.y() + 4.0 * std::sin(p.x() / 35.0 + p.y() / 150.0) +
         1.5 * std::sin(p.x() / 16.0);
}
controllers::GroundHeight hills() {
  return [](const Vector2d& p) { return std::optional<double>(hills_m(p)); };
}

/// The paper's request (section 2), on the grid of its reference: 10 lanes of 260 m, 45 m apart.
controllers::SurveyRequest make_request() {
  controllers::SurveyRequest request;
  request.polygon_W = {{0, 0}, {260, 0}, {260, 405}, {0, 405}};
  request.side_overlap = 0.66;
  request.bank_rad = rad_from_deg(35.0);
  request.stall_speed_mps = 8.4;
  request.lane_yaw_rad = 0.0;
  return request;
}

Pose start_at(double x, double y, double z, double yaw_rad = 0.0) {
  return {quaternion_from_rpy({0, 0, yaw_rad}), {x, y, z}};
}

std::string fault_of(const controllers::SurveyRequest& request,
                     const controllers::GroundHeight& ground = flat()) {
  const auto plan = controllers::plan_survey(request, start_at(-200, -100, 150), ground);
  return plan ? "none" : plan.reason();
}

double height_of_path(const PlannedPath& path, std::size_t i, double share) {
  return path.points[i].p_W.z() + share * (path.points[i + 1].p_W.z() - path.points[i].p_W.z());
}

/// A multirotor over a slope of 20 %: what a customer asks for on a field of 0.24 ha.
TEST(SurveyPlan, RotorcraftKeepsItsHeightOverASlopeAndFliesNoLaps) {
  controllers::SurveyRequest request;
  request.polygon_W = {{0, 0}, {60, 0}, {60, 40}, {0, 40}};
  request.camera.focal_length_mm = 10.26;
  request.camera.sensor_width_mm = 13.2;
  request.camera.sensor_height_mm = 8.8;
  request.height_m = 60.0;
  request.speed_mps = 5.0;
  request.side_overlap = 0.7;
  request.ramp_error_m = 1.0;
  request.max_slope = 0.3;
  request.lane_yaw_rad = 0.0;
  request.rotorcraft = true;
  const controllers::GroundHeight slope = [](const Vector2d& p) {
    return std::optional<double>(0.2 * p.x());
  };
  const auto plan = controllers::plan_survey(request, start_at(-20, -10, -4.0), slope);
  ASSERT_TRUE(plan.ok()) << plan.reason();
  const auto& points = plan->path.points;
  // Straight up from the start to 60 m above it.
  EXPECT_LT((points[0].p_W - Eigen::Vector3d(-20, -10, 56.0)).norm(), 1e-9);
  EXPECT_EQ(plan->numbers.at("wide_turns"), 0);
  EXPECT_EQ(plan->numbers.at("turn_radius_m"), 0.0);
  EXPECT_EQ(plan->numbers.at("run_out_m"), 6.25);  // 5^2 / (2 x 2)
  EXPECT_EQ(plan->numbers.at("climb_way_m"), 0.0);
  for (const controllers::SurveyShot& shot : plan->shots) EXPECT_NEAR(shot.height_m, 60.0, 1.0);
  EXPECT_NEAR(plan->numbers.at("gsd_max_mm"), plan->numbers.at("gsd_mm"),
              plan->numbers.at("gsd_mm") / 60.0);
  // Lanes, their run-outs, the steps between them, there and back: nothing else. Lanes begin half a
  // picture before the field and end half a picture behind it, in whole picture distances.
  double lanes_m = 0.0;
  for (const controllers::SurveyLane& lane : plan->lanes)
    lanes_m += lane.high_m() - lane.low_m() + 2.0 * 6.25;
  const double across_m = plan->lanes.back().across_m - plan->lanes.front().across_m;
  const double length_m = plan->numbers.at("length_m");
  const double home_m = std::hypot(110.0, 90.0);
  EXPECT_GT(length_m, lanes_m + across_m);
  EXPECT_LT(length_m, 1.03 * (lanes_m + across_m) + 2.0 * home_m);
  request.rotorcraft = false;
  const auto winged = controllers::plan_survey(request, start_at(-20, -10, -4.0), slope);
  ASSERT_TRUE(winged.ok()) << winged.reason();
  EXPECT_GT(winged->numbers.at("length_m"), length_m);
}

TEST(SurveyPlan, FliesTheSnakeOfThePaper) {
  const auto plan = controllers::plan_survey(make_request(), start_at(-200, -100, 150), flat());
  ASSERT_TRUE(plan.ok()) << plan.reason();
  const auto& numbers = plan->numbers;
  EXPECT_EQ(numbers.at("lanes"), 10);
  EXPECT_NEAR(numbers.at("lane_spacing_m"), 45.0, 1e-9);
  EXPECT_NEAR(numbers.at("turn_radius_m"), 21.0, 0.05);
  EXPECT_EQ(numbers.at("wide_turns"), 0);
  EXPECT_EQ(numbers.at("skipping_turns"), 0);
  EXPECT_NEAR(numbers.at("gsd_mm"), 104.2, 0.05);
  EXPECT_GE(numbers.at("forward_overlap_min"), 0.85 - 1e-9);
  EXPECT_NEAR(numbers.at("side_overlap"), 0.6625, 1e-9);
  EXPECT_EQ(numbers.at("covered_share"), 1.0);
  EXPECT_EQ(numbers.at("lane_bearing_deg"), 90.0);
  // Kinds in their order: to the first lane, lanes and turns in turn, home.
  std::string kinds;
  for (const PathPoint& point : plan->path.points) {
    const char c = "LTtVR"[static_cast<int>(point.kind)];
    if (kinds.empty() || kinds.back() != c) kinds += c;
  }
  std::string wanted = "t";
  for (int i = 0; i < 10; ++i) wanted += i < 9 ? "LT" : "LR";
  EXPECT_EQ(kinds, wanted);
  std::set<int> lanes;
  for (const PathPoint& point : plan->path.points) {
    EXPECT_EQ(point.alley >= 0, point.kind == PathKind::kLeg);
    if (point.alley >= 0) lanes.insert(point.alley);
  }
  EXPECT_EQ(lanes.size(), 10u);
  EXPECT_NEAR((plan->path.points.back().p_W.head<2>() - Vector2d(-200, -100)).norm(), 0.0, 1e-9);
}

TEST(SurveyPlan, TwentyCornersBecomeAboutFiftyWaypointsOverHills) {
  controllers::SurveyRequest request = make_request();
  // Waypoints at the lanes' ends only, as the paper counts: 20 of them.
  request.end_margin = 0.0;
  request.run_out_m = 0.0;
  const auto plan =
      controllers::plan_survey(request, start_at(-60, 0, 150 + hills_m({-60, 0})), hills());
  ASSERT_TRUE(plan.ok()) << plan.reason();
  EXPECT_EQ(plan->numbers.at("corners"), 20);
  int waypoints = 0;  // of lanes and turns
  for (const PathPoint& point : plan->path.points) {
    waypoints += point.kind == PathKind::kLeg || point.kind == PathKind::kTurn;
  }
  const int with_last = waypoints + 1;
  double low_m = 1e9, high_m = -1e9;
  for (double x = 0.0; x <= 260.0; x += 5.0) {
    for (double y = 0.0; y <= 405.0; y += 5.0) {
      low_m = std::min(low_m, hills_m({x, y}));
      high_m = std::max(high_m, hills_m({x, y}));
    }
  }
  EXPECT_NEAR(high_m - low_m, 28.0, 2.0);
  printf("20 corners -> %d waypoints, relief %.1f m\n", with_last, high_m - low_m);
  EXPECT_GE(with_last, 40);
  EXPECT_LE(with_last, 60);
  EXPECT_LE(plan->numbers.at("ramp_error_m"), 2.0);
}

TEST(SurveyPlan, KeepsTheRampErrorAndTheSlope) {
  controllers::SurveyRequest request = make_request();
  request.lane_yaw_rad.reset();
  const auto plan =
      controllers::plan_survey(request, start_at(-200, -100, 150 + hills_m({-200, -100})), hills());
  ASSERT_TRUE(plan.ok()) << plan.reason();
  const PlannedPath& path = plan->path;
  double min_m = 1e9, max_m = -1e9;
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
    const Eigen::Vector3d displacement = path.points[i + 1].p_W - path.points[i].p_W;
    EXPECT_LE(std::abs(displacement.z()), 0.12 * displacement.head<2>().norm() + 1e-9);
    if (path.points[i].kind == PathKind::kTransit) continue;  // the climb is not looked at here
    for (double share = 0.0; share < 1.0; share += 0.01) {
      const Vector2d p = path.points[i].p_W.head<2>() + share * displacement.head<2>();
      const double above_m = height_of_path(path, i, share) - hills_m(p);
      EXPECT_GE(above_m, 148.0);
      if (path.points[i].kind != PathKind::kLeg) continue;
      min_m = std::min(min_m, above_m);
      max_m = std::max(max_m, above_m);
    }
  }
  EXPECT_NEAR(plan->numbers.at("height_above_ground_min_m"), min_m, 0.05);
  EXPECT_NEAR(plan->numbers.at("height_above_ground_max_m"), max_m, 0.05);
  EXPECT_EQ(plan->numbers.at("covered_share"), 1.0);
}

TEST(SurveyPlan, SeesEveryPlaceAsOftenAsTheOverlapSays) {
  for (const Polygon& polygon :
       {Polygon{{0, 0}, {260, 0}, {260, 405}, {0, 405}},
        Polygon{{0, 0}, {300, 60}, {420, 300}, {180, 260}, {60, 420}},  // not convex
        Polygon{
            {0, 0}, {500, 0}, {500, 300}, {400, 300}, {400, 90}, {90, 90}, {90, 300}, {0, 300}}}) {
    controllers::SurveyRequest request = make_request();
    request.polygon_W = polygon;
    request.lane_yaw_rad.reset();
    request.height_m = 130.0;
    const auto plan = controllers::plan_survey(request, start_at(-200, -100, 130), flat());
    ASSERT_TRUE(plan.ok()) << plan.reason();
    EXPECT_EQ(plan->numbers.at("covered_share"), 1.0);
    // A lane alone shows every place 1 / (1 - q) times; the lanes on both sides do.
    EXPECT_GE(plan->numbers.at("views_min"), 6.0);
    // Independent of the forecast: the shots' spacing along each lane.
    const double step_m = plan->numbers.at("photo_distance_m");
    for (std::size_t i = 0; i + 1 < plan->shots.size(); ++i) {
      const controllers::SurveyShot &a = plan->shots[i], &b = plan->shots[i + 1];
      const double gap_m = (b.p_W - a.p_W).head<2>().norm();
      if (a.lane == b.lane && gap_m < 80.0) {
        EXPECT_NEAR(gap_m, step_m, 1e-6);
      }
    }
  }
}

TEST(SurveyPlan, TurnsOnlyAsTheAircraftCan) {
  controllers::SurveyRequest request = make_request();
  request.side_overlap = 0.80;  // 26.7 m
  const auto plan = controllers::plan_survey(request, start_at(-200, -100, 150), flat());
  ASSERT_TRUE(plan.ok()) << plan.reason();
  EXPECT_EQ(plan->numbers.at("wide_turns"), 0);
  EXPECT_GT(plan->numbers.at("skipping_turns"), 10);
  // Corners turn by a quarter, and lie two radii apart.
  const double radius_m = plan->numbers.at("turn_radius_m");
  std::vector<Vector2d> corners;
  for (const PathPoint& point : plan->path.points) {
    if (point.kind == PathKind::kTransit || point.kind == PathKind::kReturn) continue;
    corners.push_back(point.p_W.head<2>());
  }
  Vector2d last_turn = corners.front() - Vector2d(1e3, 0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vector2d in = corners[i] - corners[i - 1], out = corners[i + 1] - corners[i];
    const double angle = std::abs(std::atan2(cross(in, out), in.dot(out)));
    if (angle < 1e-6) continue;
    EXPECT_NEAR(angle, 0.5 * kPi, 1e-6);
    EXPECT_GE((corners[i] - last_turn).norm(), 2.0 * radius_m - 1e-6);
    last_turn = corners[i];
  }
  request.order = controllers::SurveyRequest::Order::kSnake;
  const auto snake = controllers::plan_survey(request, start_at(-200, -100, 150), flat());
  EXPECT_GT(snake->numbers.at("wide_turns"), 10);
  EXPECT_GT(snake->path.length_m, plan->path.length_m);
}

TEST(SurveyPlan, RefusesWhatTheCameraCannotDoWithTheNumbersThatWouldWork) {
  controllers::SurveyRequest request = make_request();
  request.height_m = request.camera.height_for_gsd_m(0.041);
  EXPECT_EQ(
      fault_of(request),
      "85 % forward overlap at 59 m and 12.0 m/s over ground needs a picture every 5.9 m, but "
      "camera 'rededge' takes 1 a second and reaches 69.5 %: it needs at most 5.9 m/s at 59 m "
      "(below the stall speed of 8.4 m/s), or a camera with 2.04 Hz, or at least 120 m for "
      "12.0 m/s (GSD 83 mm)");
  // What it names works.
  request.camera.max_rate_Hz = 2.04;
  EXPECT_EQ(fault_of(request), "none");
  request = make_request();
  request.height_m = 120.0;
  EXPECT_EQ(fault_of(request), "none");
  request.height_m = 119.0;
  EXPECT_NE(fault_of(request), "none");
  request = make_request();
  request.speed_mps = 15.0;  // the paper's limit
  EXPECT_EQ(fault_of(request), "none");
  request.speed_mps = 15.01;
  EXPECT_NE(fault_of(request).find("at most 15.0 m/s at 150 m, or a camera"), std::string::npos)
      << fault_of(request);
}

TEST(SurveyPlan, ATailWindCounts) {
  controllers::SurveyRequest request = make_request();
  request.wind_W = {3.5, 0.0};
  EXPECT_NE(fault_of(request).find("15.5 m/s over ground (wind from behind)"), std::string::npos);
  EXPECT_NE(fault_of(request).find("at most 11.5 m/s through this wind"), std::string::npos);
  request.speed_mps = 11.5;
  EXPECT_EQ(fault_of(request), "none");
  request.speed_mps = 12.0;
  request.wind_W = {0.0, 3.5};  // from the side: slower over ground
  const auto plan = controllers::plan_survey(request, start_at(-200, -100, 150), flat());
  ASSERT_TRUE(plan.ok());
  EXPECT_NEAR(plan->numbers.at("ground_speed_max_mps"), std::sqrt(144.0 - 12.25), 1e-9);
  // Turns are planned for the wind from behind.
  EXPECT_NEAR(plan->numbers.at("turn_radius_m"),
              15.5 * 15.5 / (9.80665 * std::tan(request.bank_rad)), 1e-9);
  request.wind_W = {0.0, 13.0};
  EXPECT_EQ(fault_of(request), "speed_mps = 12 m/s must be above the wind's 13 m/s");
  request = make_request();
  request.speed_mps = 8.0;
  EXPECT_EQ(fault_of(request), "speed_mps = 8.0 m/s must be above the stall speed of 8.4 m/s");
}

TEST(SurveyPlan, RefusesPolygonsThatCrossThemselvesOrLeaveTheTerrain) {
  controllers::SurveyRequest request = make_request();
  request.polygon_W = {{0, 0}, {100, 100}, {100, 0}, {0, 100}};
  EXPECT_NE(fault_of(request).find("the polygon cannot be surveyed: its edge from point 1"),
            std::string::npos);
  request = make_request();
  const controllers::GroundHeight small = [](const Vector2d& p) {
    return p.y() <= 400.0 ? std::optional<double>(0.0) : std::nullopt;
  };
  // (260, 405) towards (130, 202.5): 5 m down is 5.94 m along.
  EXPECT_EQ(fault_of(request, small),
            "point 3 of the polygon at (260.0, 405.0) is outside the terrain, which starts 6.0 m "
            "from there towards the polygon's centre");
  const controllers::GroundHeight holed = [](const Vector2d& p) {
    return (p - Vector2d(100, 100)).norm() > 9.0 ? std::optional<double>(0.0) : std::nullopt;
  };
  EXPECT_NE(fault_of(request, holed).find("the polygon has no terrain at (9"), std::string::npos);
}

TEST(SurveyPlan, CountsLanesAndPicturesBeforeItPlansThem) {
  controllers::SurveyRequest request = make_request();
  request.polygon_W = {{0, 0}, {30e3, 0}, {30e3, 40e3}, {0, 40e3}};
  const std::string fault = fault_of(request);
  EXPECT_EQ(fault.find("30000 m x 40000 m at "), 0u) << fault;
  // 40 km / 45.3 m
  EXPECT_NE(fault.find(" would take 883 lanes 45.3 m apart and "), std::string::npos) << fault;
  EXPECT_NE(fault.find("must be at most 1000 lanes and 200000 pictures"), std::string::npos);
}

TEST(SurveyPlan, ClimbsInLapsWhereTheFirstLaneIsNear) {
  const auto plan = controllers::plan_survey(make_request(), start_at(-150, -60, 0.3, 0.5), flat());
  ASSERT_TRUE(plan.ok()) << plan.reason();
  const PlannedPath& path = plan->path;
  // 150 m at 12 % are 1250 m of way.
  EXPECT_NEAR(plan->numbers.at("climb_way_m"), (150.0 - 0.3) / 0.12, 2.0);
  double distance_m = 0.0;
  for (std::size_t i = 0; path.points[i].kind == PathKind::kTransit; ++i) {
    const Eigen::Vector3d step = path.points[i + 1].p_W - path.points[i].p_W;
    EXPECT_LE(std::abs(step.z()), 0.12 * step.head<2>().norm() + 1e-9) << i;
    distance_m += step.head<2>().norm();
    if (i == 0) {  // straight on first
      EXPECT_NEAR(path.points[0].yaw_rad, 0.5, 1e-9);
    }
  }
  EXPECT_GT(distance_m, 1250.0);
  EXPECT_LT(distance_m, 1700.0);
  for (const PathPoint& point : path.points) {
    if (point.kind == PathKind::kLeg) {
      EXPECT_NEAR(point.p_W.z(), 150.0, 1e-9);
    }
  }
  // Into a hillside of 16 % that is not possible, away from it is.
  const controllers::GroundHeight slope = [](const Vector2d& p) {
    return std::optional<double>(0.16 * p.y());
  };
  const auto uphill =
      controllers::plan_survey(make_request(), start_at(130, -150, -23.0, 0.5 * kPi), slope);
  ASSERT_FALSE(uphill.ok());
  EXPECT_NE(uphill.reason().find("at 12 % meets the ground at ("), std::string::npos)
      << uphill.reason();
  EXPECT_TRUE(
      controllers::plan_survey(make_request(), start_at(130, -150, -23.0, -0.5 * kPi), slope).ok());
}

/// Tangents of two turns that follow each other fit between their corners: also on the way to the
/// first lane and home, wherever the start is.
TEST(SurveyPlan, EveryCornerCanBeFlown) {
  for (int place = 0; place < 24; ++place) {
    const double angle = 2.0 * kPi * place / 24.0, away_m = place % 3 == 0 ? 120.0 : 420.0;
    const double height_m = place % 2 == 0 ? 150.0 : 0.0;
    const auto plan =
        controllers::plan_survey(make_request(),
                                 start_at(130.0 + away_m * std::cos(angle),
                                          200.0 + away_m * std::sin(angle), height_m, angle),
                                 flat());
    ASSERT_TRUE(plan.ok()) << plan.reason();
    const double radius_m = plan->numbers.at("turn_radius_m");
    std::vector<Vector2d> corners;
    for (const PathPoint& point : plan->path.points) {
      const Vector2d p = point.p_W.head<2>();
      if (corners.size() > 1) {  // points on a straight are no corners
        const Vector2d a = corners.back() - corners[corners.size() - 2], b = p - corners.back();
        if (std::abs(std::atan2(cross(a, b), a.dot(b))) < 1e-6) corners.pop_back();
      }
      corners.push_back(p);
    }
    double before_m = 0.0;
    for (std::size_t i = 1; i < corners.size(); ++i) {
      double after_m = 0.0;
      const Vector2d in = corners[i] - corners[i - 1];
      if (i + 1 < corners.size()) {
        const Vector2d out = corners[i + 1] - corners[i];
        const double turn = std::abs(std::atan2(cross(in, out), in.dot(out)));
        EXPECT_LT(turn, 2.61) << place << " corner " << i;
        after_m = radius_m * std::tan(0.5 * turn);
      }
      EXPECT_GE(in.norm(), before_m + after_m - 1e-6) << place << " corner " << i;
      before_m = after_m;
    }
  }
}

TEST(SurveyPlan, GivesTheSameBitsTwice) {
  const auto plan = [] {
    return controllers::plan_survey(make_request(), start_at(-200, -100, 20), hills()).value();
  };
  const controllers::SurveyPlan a = plan(), b = plan();
  ASSERT_EQ(a.path.points.size(), b.path.points.size());
  for (std::size_t i = 0; i < a.path.points.size(); ++i) {
    EXPECT_EQ(a.path.points[i].p_W, b.path.points[i].p_W);
  }
  EXPECT_EQ(a.numbers, b.numbers);
}

}  // namespace
}  // namespace vinerow::test::survey_plan_test
