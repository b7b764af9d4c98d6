/// Surveys planned for a wind, flown in it by waypoint_guidance: what turns leave at the lanes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/parts/paths/pose2.h"
#include "controllers/planning/survey/survey_plan.h"
#include "controllers/waypoint_guidance/heading_generator.h"
#include "engine/math/angles.h"
#include "tests/controllers/waypoint_guidance/air_bench.h"

namespace vinerow::test::survey_wind_test {
namespace {

using Eigen::Vector2d;

/// Lanes of 260 m, 45 m apart, along x: the paper's grid.
controllers::SurveyPlan plan_for(const Vector2d& wind_W) {
  controllers::SurveyRequest request;
  request.polygon_W = {{0, 0}, {260, 0}, {260, 315}, {0, 315}};
  request.bank_rad = rad_from_deg(35.0);
  request.stall_speed_mps = 8.4;
  request.lane_yaw_rad = 0.0;
  request.wind_W = wind_W;
  const Pose start{Eigen::Quaterniond::Identity(), {-300, -100, 150}};
  Result<controllers::SurveyPlan> plan = controllers::plan_survey(
      request, start, [](const Vector2d&) { return std::optional<double>(0.0); });
  EXPECT_TRUE(plan.ok()) << plan.reason();
  return std::move(plan).value();
}

struct Lane {
  Vector2d from, along;
  double entry_m = -1.0;  ///< off the lane where its pictures begin
};

struct Flight {
  std::vector<Lane> lanes;
  bool has_warning = false;
  double worst_m() const {
    double worst = 0.0;
    for (const Lane& lane : lanes) worst = std::max(worst, lane.entry_m);
    return worst;
  }
};

Flight fly(const controllers::SurveyPlan& plan, const Vector2d& wind_W) {
  Flight flight;
  const auto& points = plan.path.points;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i].kind != PathKind::kLeg) continue;
    if (i > 0 && points[i - 1].alley == points[i].alley) continue;
    const Vector2d displacement = (points[i + 1].p_W - points[i].p_W).head<2>();
    flight.lanes.push_back({points[i].p_W.head<2>(), displacement.normalized()});
  }
  PlaneOptions options;
  options.start_W = points.front().p_W;
  options.wind = wind_W;
  AirBench bench({{"end", std::string("stop")}}, options);
  bench.give_plan(plan.path);
  std::optional<Vector2d> before;
  bench.fly(2000.0, [&](double, const Odometry& seen, const AirReference&) {
    const Vector2d now = seen.X_WB.p.head<2>();
    for (Lane& lane : flight.lanes) {
      if (!before || (*before - lane.from).dot(lane.along) >= 0.0) continue;
      const Vector2d off = now - lane.from;
      if (off.dot(lane.along) < 0.0) continue;
      constexpr double kNear_m = 20.0;  // else it begins another lane
      const double entry_m = std::abs(cross(lane.along, off));
      if (entry_m < kNear_m) lane.entry_m = std::max(lane.entry_m, entry_m);
    }
    before = now;
  });
  for (const Event& event : bench.events()) {
    flight.has_warning = flight.has_warning || event.level != Event::Level::kInfo;
  }
  for (const Lane& lane : flight.lanes) EXPECT_GE(lane.entry_m, 0.0) << "never begun";
  return flight;
}

TEST(SurveyInWind, LanesAreEnteredAsInStillAirWhereTheWindIsTold) {
  const Flight still = fly(plan_for({0, 0}), {0, 0});
  ASSERT_EQ(still.lanes.size(), 8u);
  EXPECT_FALSE(still.has_warning);
  EXPECT_LT(still.worst_m(), 1.0);
  RecordProperty("still_m", std::to_string(still.worst_m()));
  for (const double to_deg : {0.0, 90.0, 135.0, 270.0}) {
    const Vector2d wind_W = 3.0 * controllers::direction(rad_from_deg(to_deg));
    const controllers::SurveyPlan plan = plan_for(wind_W);
    EXPECT_EQ(plan.numbers.at("skipping_turns"), 7.0) << to_deg;
    const Flight flight = fly(plan, wind_W);
    EXPECT_FALSE(flight.has_warning) << to_deg;
    EXPECT_LE(flight.worst_m(), still.worst_m() + 1.0) << to_deg;
    RecordProperty("to_" + std::to_string(static_cast<int>(to_deg)) + "_deg_m",
                   std::to_string(flight.worst_m()));
  }
  // If the plan ignores the wind, its turns drift past the next lane.
  EXPECT_GT(fly(plan_for({0, 0}), {0.0, -3.0}).worst_m(), still.worst_m() + 5.0);
}

TEST(SurveyInWind, TwoRadiiHoldAUTurnWithItsDrift) {
  for (const double speed_mps : {10.0, 12.0, 15.0}) {
    for (const double bank_deg : {25.0, 35.0, 45.0}) {
      controllers::TurnLimits limits;
      limits.bank_rad = rad_from_deg(bank_deg);
      limits.bank_rate_radps = rad_from_deg(60.0);
      controllers::HeadingGenerator generator(limits);
      for (const double wind_mps : {0.0, 1.0, 3.0, 5.0}) {
        controllers::SurveyRequest request;
        request.speed_mps = speed_mps;
        request.bank_rad = limits.bank_rad;
        request.wind_W = {0.0, wind_mps};
        // From a lane along -x to one along x, to the left of which the wind blows: crabbing on
        // both, turning right.
        const double crab_rad = std::asin(wind_mps / speed_mps);
        generator.start(kPi + crab_rad);
        const controllers::PredictedTurn turn = controllers::predict_turn(
            generator, {0.0, 0.0}, -crab_rad, 0.0, request.wind_W, speed_mps);
        EXPECT_LE(turn.at_rest.y(), 2.0 * controllers::calc_turn_radius_m(request) + 0.3)
            << speed_mps << " " << bank_deg << " " << wind_mps;
      }
    }
  }
}

}  // namespace
}  // namespace vinerow::test::survey_wind_test
