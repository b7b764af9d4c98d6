// Geometry of legs, turns, ramps and landing slopes of guidance `waypoint_guidance`, against closed
// forms.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "controllers/parts/aircraft/wind_estimate.h"
#include "controllers/parts/aircraft/wind_triangle.h"
#include "controllers/parts/paths/leg_frame.h"
#include "controllers/waypoint_guidance/flight_legs.h"
#include "controllers/waypoint_guidance/heading_generator.h"
#include "controllers/waypoint_guidance/height_reference.h"
#include "controllers/waypoint_guidance/landing_slope.h"
#include "controllers/waypoint_guidance/leg_pilot.h"
#include "engine/math/angles.h"
#include "tests/controllers/waypoint_guidance/air_bench.h"

namespace vinerow::test::air_legs_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Eq. 1 as printed, E = x and N = y.
double printed_distance_m(const Eigen::Vector3d& i, const Eigen::Vector3d& j,
                          const Eigen::Vector2d& p) {
  const double m = (j.x() - i.x()) / (j.y() - i.y());
  return std::abs(p.x() - m * p.y() - (i.x() - m * i.y())) / std::sqrt(m * m + 1.0);
}

TEST(LegFrame, DistanceIsThatOfEquationOneWithASign) {
  // 22.3607 m: the number of the reference, 10 sqrt(5).
  const Eigen::Vector3d i(0, 0, 0), j(100, 200, 0);
  const Eigen::Vector2d p(50, 50);
  const controllers::LegFrame leg(i, j);
  EXPECT_NEAR(printed_distance_m(i, j, p), 22.3607, 5e-5);
  EXPECT_NEAR(leg.left_m(p), -22.360679774997898, 1e-12);  // right of the track
  EXPECT_NEAR(controllers::LegFrame(j, i).left_m(p), 22.360679774997898, 1e-12);
  EXPECT_NEAR(leg.along_m(p), (100.0 * 50 + 200.0 * 50) / std::sqrt(50000.0), 1e-12);
}

TEST(LegFrame, EastWestLegsHaveADistance) {
  const controllers::LegFrame east({-10, 5, 0}, {90, 5, 0}), west({90, 5, 0}, {-10, 5, 0});
  EXPECT_DOUBLE_EQ(east.left_m({20, 8}), 3.0);
  EXPECT_DOUBLE_EQ(west.left_m({20, 8}), -3.0);
  EXPECT_DOUBLE_EQ(east.along_m({20, 8}), 30.0);
  EXPECT_DOUBLE_EQ(west.course_rad(), kPi);
}

TEST(LegFrame, FootLiesOnTheLegAndAtRightAngles) {
  const controllers::LegFrame leg({3, -4, 0}, {50, 31, 0});
  const Eigen::Vector2d p(10, 40), foot = leg.foot(p);
  EXPECT_NEAR(leg.left_m(foot), 0.0, 1e-12);
  EXPECT_NEAR(leg.along_m(foot), leg.along_m(p), 1e-12);
  EXPECT_NEAR((p - foot).norm(), std::abs(leg.left_m(p)), 1e-12);
  // Eq. 4-5 of the reference with e right of the track and chi from north.
  const double e = -leg.left_m(p), chi = 0.5 * kPi - leg.course_rad();
  EXPECT_NEAR(foot.x(), p.x() - e * std::cos(chi), 1e-12);
  EXPECT_NEAR(foot.y(), p.y() + e * std::sin(chi), 1e-12);
}

TEST(LegFrame, RampRunsOnlyInsideTheLeg) {
  const controllers::LegFrame leg({0, 0, 100}, {200, 0, 110});
  EXPECT_DOUBLE_EQ(leg.height_m(-30.0), 100.0);
  EXPECT_DOUBLE_EQ(leg.height_m(50.0), 102.5);
  EXPECT_DOUBLE_EQ(leg.height_m(260.0), 110.0);
  EXPECT_DOUBLE_EQ(leg.climb_rad(50.0), std::atan(0.05));
  EXPECT_DOUBLE_EQ(leg.climb_rad(-1.0), 0.0);
  EXPECT_DOUBLE_EQ(leg.climb_rad(201.0), 0.0);
}

TEST(LegFrame, ToleranceIsInMetres) {
  EXPECT_DOUBLE_EQ(controllers::calc_cross_track_tolerance_m(0.0, 4.0, 1.0), 4.0);
  EXPECT_DOUBLE_EQ(controllers::calc_cross_track_tolerance_m(0.5, 4.0, 1.0), 2.0);
  EXPECT_DOUBLE_EQ(controllers::calc_cross_track_tolerance_m(0.9, 4.0, 1.0), 1.0);
}

TEST(WindTriangle, HeadingIntoTheWindHoldsTheCourse) {
  // 3-4-5: east at 5 m/s through the air in 3 m/s from the north.
  const controllers::Crab crab = controllers::calc_crab(0.0, {0.0, -3.0}, 5.0);
  EXPECT_NEAR(crab.angle_rad, std::asin(0.6), 1e-12);
  EXPECT_NEAR(crab.ground_speed_mps, 4.0, 1e-12);
  EXPECT_TRUE(crab.is_possible);
  const Eigen::Vector2d v = controllers::calc_ground_velocity(crab.angle_rad, {0.0, -3.0}, 5.0);
  EXPECT_NEAR(v.y(), 0.0, 1e-12);
  EXPECT_FALSE(controllers::calc_crab(0.0, {0.0, -5.1}, 5.0).is_possible);
  EXPECT_DOUBLE_EQ(controllers::calc_crab(0.0, {0.0, -5.1}, 5.0).angle_rad, 0.5 * kPi);
  EXPECT_FALSE(controllers::calc_crab(0.0, {-5.1, 0.0}, 5.0).is_possible);  // blown back
  EXPECT_TRUE(controllers::calc_crab(0.0, {-4.9, 0.0}, 5.0).is_possible);
}

TEST(WindEstimate, IsTheMeanAtFirstAndALowPassLater) {
  controllers::WindEstimate wind(10.0);
  Odometry odometry;
  odometry.X_WB.q = quaternion_from_rpy({0.2, 0.1, 2.0});
  const auto add = [&](const Eigen::Vector3d& wind_W) {
    odometry.v_WB_B = {12.0, 0.3, -0.2};
    wind.add(odometry, {odometry.v_WB_B - odometry.X_WB.q.conjugate() * wind_W}, 0.05);
  };
  add({3.0, -4.0, 0.7});
  EXPECT_NEAR((wind.wind_W() - Eigen::Vector2d(3, -4)).norm(), 0.0, 1e-12);
  add({1.0, 0.0, 0.0});
  EXPECT_NEAR((wind.wind_W() - Eigen::Vector2d(2, -2)).norm(), 0.0, 1e-12);
  for (int i = 0; i < 400; ++i) add({2.0, -2.0, 0.0});
  for (int i = 0; i < 200; ++i) add({7.0, -2.0, 0.0});
  EXPECT_NEAR(wind.wind_W().x(), 7.0 - 5.0 * std::exp(-1.0), 1e-9);
  AirData broken;
  broken.v_air_B.x() = NAN;
  wind.add(odometry, broken, 0.05);
  EXPECT_TRUE(wind.wind_W().allFinite());
}

controllers::TurnLimits make_limits(double bank_deg = 35.0) {
  controllers::TurnLimits limits;
  limits.bank_rad = rad_from_deg(bank_deg);
  limits.bank_rate_radps = rad_from_deg(60.0);
  // The reference's generator: one lag.
  limits.gain_per_s = 1.2;
  limits.bank_lag_s = 0.45;
  limits.yaw_lag_s = 0.0;
  return limits;
}

TEST(TurnLimits, RadiiAreThoseOfTheReference) {
  const auto radius_m = [](double bank_deg, double v) { return make_limits(bank_deg).radius_m(v); };
  EXPECT_NEAR(radius_m(30, 12), 25.4, 0.05);
  EXPECT_NEAR(radius_m(35, 12), 21.0, 0.05);
  EXPECT_NEAR(radius_m(45, 12), 14.7, 0.05);
  EXPECT_NEAR(radius_m(30, 15), 39.7, 0.05);
  EXPECT_NEAR(radius_m(35, 15), 32.8, 0.05);
  EXPECT_NEAR(radius_m(45, 15), 22.9, 0.05);
}

TEST(HeadingGenerator, FullBankComesAfterRateAndLag) {
  // A bank that comes at a rate and then with a lag is late by bank / (2 rate) + lag.
  controllers::HeadingGenerator generator(make_limits());
  generator.start(0.0);
  const double dt_s = 0.0005, bank_rad = rad_from_deg(35.0);
  double sum_rads = 0.0;
  for (int i = 0; i < 12000; ++i) {
    generator.advance(dt_s, 100.0, 0.0, 12.0);
    sum_rads += dt_s * generator.bank_left_rad();
  }
  EXPECT_NEAR(generator.bank_left_rad(), bank_rad, 1e-5);
  EXPECT_NEAR(generator.rate_radps(), 9.80665 * std::tan(bank_rad) / 12.0, 1e-4);
  EXPECT_NEAR(sum_rads / bank_rad, 6.0 - (35.0 / 120.0 + 0.45), 1e-3);
}

TEST(HeadingGenerator, HeadingLagsTheBankByTheYawLag) {
  controllers::TurnLimits limits = make_limits();
  limits.yaw_lag_s = 0.3;
  controllers::HeadingGenerator lagging(limits), plain(make_limits());
  lagging.start(0.0);
  plain.start(0.0);
  for (int i = 0; i < 24000; ++i) {
    for (controllers::HeadingGenerator* generator : {&lagging, &plain}) {
      generator->advance(0.0005, 100.0, 0.0, 12.0);
    }
  }
  EXPECT_EQ(lagging.bank_left_rad(), plain.bank_left_rad());
  // A lag of a rate costs its time at the full rate, less half a step.
  EXPECT_NEAR(plain.heading_rad() - lagging.heading_rad(), (0.3 - 0.00025) * plain.rate_radps(),
              1e-6);
}

TEST(HeadingGenerator, SettlesOnTheHeadingAndIsMirrored) {
  controllers::HeadingGenerator left(make_limits()), right(make_limits());
  left.start(0.3, 0.1);
  right.start(-0.3, -0.1);
  double max_rad = 0.0;
  for (int i = 0; i < 400; ++i) {
    left.advance(0.05, 3.3, 0.01, 12.0);
    right.advance(0.05, -3.3, -0.01, 12.0);
    ASSERT_EQ(left.heading_rad(), -right.heading_rad());
    ASSERT_EQ(left.bank_left_rad(), -right.bank_left_rad());
    max_rad = std::max(max_rad, left.heading_rad());
  }
  EXPECT_NEAR(left.heading_rad(), 3.3 + 0.01 / 1.2, 1e-6);
  EXPECT_LT(max_rad, 3.3 + rad_from_deg(4.0));
}

TEST(HeadingGenerator, PredictionEndsWhereTheTurnEnds) {
  controllers::HeadingGenerator generator(make_limits());
  generator.start(0.0);
  const Eigen::Vector2d wind(2.0, -1.0);
  const controllers::PredictedTurn turn =
      controllers::predict_turn(generator, {10, 20}, 1.5, 0.0873, wind, 12.0);
  // The same turn flown by the guidance's ticks, the way by Simpson's rule.
  Eigen::Vector2d p(10, 20);
  while (std::abs(1.5 - generator.heading_rad()) > rad_from_deg(0.5) ||
         std::abs(generator.bank_left_rad()) > rad_from_deg(2.0)) {
    const double before_rad = generator.heading_rad(), rate_radps = generator.rate_radps();
    generator.advance(0.05, 1.5, 0.0, 12.0);
    const double after_rad = generator.heading_rad();
    const double middle_rad =
        0.5 * (before_rad + after_rad) + 0.05 / 8.0 * (rate_radps - generator.rate_radps());
    const auto v = [&](double yaw_rad) {
      return controllers::calc_ground_velocity(yaw_rad, wind, 12.0);
    };
    p += 0.05 / 6.0 * (v(before_rad) + 4.0 * v(middle_rad) + v(after_rad));
  }
  EXPECT_LT((turn.at_rest - p).norm(), 0.05);
  EXPECT_GT((turn.at_rest - turn.near_end).norm(), 5.0);
}

TEST(HeadingGenerator, PredictionOfAnEndlessTurnEnds) {
  controllers::TurnLimits limits = make_limits();
  limits.bank_rad = 1e-9;
  controllers::HeadingGenerator generator(limits);
  generator.start(0.0);
  const controllers::PredictedTurn turn =
      controllers::predict_turn(generator, {0, 0}, 1.5, 0.05, {0, 0}, 12.0);
  EXPECT_NEAR(turn.at_rest.x(), 1e5 * 0.05 * 12.0, 1.0);
}

controllers::FlightLegsOptions make_options() {
  controllers::FlightLegsOptions options;
  options.turn = make_limits();
  options.min_airspeed_mps = 9.3;
  options.max_airspeed_mps = 20.0;
  return options;
}

TEST(FlyBy, IsTheFormulaOfTheReference) {
  const double delay_s = 35.0 / 120.0 + 0.45, radius_m = make_limits().radius_m(12.0);
  EXPECT_NEAR(controllers::calc_fly_by_m(make_limits(), 0.5 * kPi, 12.0, 12.0),
              radius_m + 12.0 * delay_s, 1e-9);
  EXPECT_NEAR(controllers::calc_fly_by_m(make_limits(), -rad_from_deg(60), 12.0, 12.0),
              radius_m * std::tan(rad_from_deg(30)) + 12.0 * delay_s, 1e-9);
}

TEST(FlightLegs, KnowTheirPlaceAlongThePlan) {
  PlannedPath plan = make_waypoints({{0, 0, 1}, {0, 0.05, 2}, {0, 100, 2}, {80, 100, 3}});
  plan.points[2].speed_mps = 15.0;
  const auto legs = controllers::make_flight_legs(plan, make_options());
  ASSERT_TRUE(legs.ok());
  ASSERT_EQ(legs->legs.size(), 2u);  // two waypoints in one place are one
  EXPECT_DOUBLE_EQ(legs->legs[0].frame.from_W().z(), 2.0);
  EXPECT_EQ(legs->legs[0].waypoint, 2);
  EXPECT_EQ(legs->legs[1].waypoint, 3);
  EXPECT_DOUBLE_EQ(legs->legs[1].start_m, legs->legs[0].frame.length_m());
  EXPECT_DOUBLE_EQ(legs->legs[0].airspeed_mps, 12.0);
  EXPECT_DOUBLE_EQ(legs->legs[1].airspeed_mps, 15.0);
  EXPECT_THAT(legs->warnings, ElementsAre());
}

TEST(FlightLegs, RefusePlansThatAreNone) {
  EXPECT_EQ(controllers::make_flight_legs({}, make_options()).reason(),
            "plan has 0 waypoints apart from each other, needs two or more");
  EXPECT_EQ(controllers::make_flight_legs(make_waypoints({{1, 2, 3}, {1, 2, 9}}), make_options())
                .reason(),
            "plan has 1 waypoint apart from each other, needs two or more");
  EXPECT_EQ(controllers::make_flight_legs(make_waypoints({{1, 2, 3}, {1, NAN, 9}}), make_options())
                .reason(),
            "waypoint 1 of the plan is not finite");
}

TEST(FlightLegs, WarnOfLanesNearerThanTheTurnsTake) {
  EXPECT_THAT(controllers::make_flight_legs(make_lanes(4, 200, 42.0, 50), make_options())->warnings,
              ElementsAre());
  EXPECT_THAT(controllers::make_flight_legs(make_lanes(4, 200, 40.0, 50), make_options())->warnings,
              ElementsAre("waypoint 2 is 40.0 m after its predecessor and the turns there take "
                          "41.9 m (radius 21.0 m at 12.0 m/s and 35 deg of bank), and 2 more are "
                          "too near: overshoots there"));
  EXPECT_THAT(controllers::make_flight_legs(make_lanes(3, 200, 40.0, 50), make_options())->warnings,
              ElementsAre(::testing::HasSubstr(", and 1 more is too near: overshoots there")));
}

TEST(FlightLegs, WarnOfSlopesAndSpeedsThatAreNotFlown) {
  PlannedPath plan = make_waypoints({{0, 0, 0}, {0, 100, 30}, {0, 300, 30}});
  plan.points[1].speed_mps = 25.0;
  controllers::FlightLegsOptions options = make_options();
  options.climb_max_rad = rad_from_deg(10.0);
  EXPECT_THAT(controllers::make_flight_legs(plan, options)->warnings,
              ElementsAre("the plan wants 25.0 m/s, which is not in the range 9.3 to 20.0 m/s that "
                          "can be flown with the turns' bank: flies the nearest",
                          "the path to waypoint 1 climbs 16.7 deg and the guidance climbs at most "
                          "10.0 deg: the height lags there"));
}

TEST(Height, KinksAreParabolasThatMeetTheRamps) {
  const auto legs = controllers::make_flight_legs(
                        make_waypoints({{0, 0, 100}, {200, 0, 120}, {300, 0, 115}}), make_options())
                        ->legs;
  constexpr double kKink_m = 10.0;
  // At the kink: half the slopes' difference times a quarter of the length below the corner.
  EXPECT_NEAR(controllers::calc_height(legs, 0, 200.0, kKink_m).height_m,
              120.0 - 0.15 * kKink_m / 4.0, 1e-12);
  EXPECT_NEAR(controllers::calc_height(legs, 0, 200.0, kKink_m).slope, 0.025, 1e-12);
  EXPECT_NEAR(controllers::calc_height(legs, 0, 190.0, kKink_m).height_m, 119.0, 1e-12);
  EXPECT_NEAR(controllers::calc_height(legs, 1, 10.0, kKink_m).height_m, 119.5, 1e-12);
  // Continuous with its slope everywhere, and the same seen from either leg.
  double before_m = controllers::calc_height(legs, 0, 0.0, kKink_m).height_m;
  for (double s = 0.25; s < 299.0; s += 0.25) {
    const controllers::HeightPoint here = controllers::calc_height(legs, 0, s, kKink_m);
    const controllers::HeightPoint middle = controllers::calc_height(legs, 0, s - 0.125, kKink_m);
    ASSERT_NEAR((here.height_m - before_m) / 0.25, middle.slope, 1e-9) << s;
    ASSERT_NEAR(controllers::calc_height(legs, 1, s - 200.0, kKink_m).height_m, here.height_m, 1e-9)
        << s;
    before_m = here.height_m;
  }
  EXPECT_DOUBLE_EQ(controllers::calc_height(legs, 0, 200.0, 0.0).height_m, 120.0);
  EXPECT_DOUBLE_EQ(controllers::calc_height(legs, 1, 150.0, kKink_m).height_m, 115.0);
  EXPECT_DOUBLE_EQ(controllers::calc_height(legs, 0, -50.0, kKink_m).height_m, 100.0);
}

TEST(Height, ReferenceHasNoLagOnRampsAndKeepsItsRate) {
  controllers::HeightReference height;
  height.start(10.0);
  double wanted_m = 10.0;
  for (int i = 0; i < 200; ++i) {
    wanted_m += 0.05 * 1.0;
    height.advance(0.05, wanted_m, 1.0, -2.0, 2.0);
    ASSERT_NEAR(height.height_m(), wanted_m, 0.06);  // one tick
  }
  for (int i = 0; i < 20; ++i) {
    const double before_m = height.height_m();
    height.advance(0.05, wanted_m - 30.0, 0.0, -2.0, 2.0);
    ASSERT_NEAR(height.height_m() - before_m, -0.1, 1e-9);
  }
  EXPECT_NEAR(height.climb_rad(12.0), -std::asin(2.0 / 12.0), 1e-12);
}

TEST(LandingSlope, GlidesAndFlaresToTheTouchdown) {
  const double glide = rad_from_deg(5.0);
  const controllers::LandingSlope slope(7.0, glide, 2.0);
  const double length_m = slope.length_m(30.0);
  EXPECT_NEAR(slope.at(length_m).height_m, 37.0, 1e-9);
  EXPECT_NEAR(slope.at(0.0).height_m, 7.0, 1e-9);
  const double flare_at_m = slope.length_m(2.0);
  EXPECT_NEAR(slope.at(flare_at_m).height_m, 9.0, 1e-9);
  EXPECT_NEAR(slope.at(flare_at_m + 20.0).height_m, 9.0 + 20.0 * std::tan(glide), 1e-9);
  // Fades from the glide's slope to 0.15 / 1.15 of it.
  EXPECT_NEAR(slope.at(flare_at_m - 1e-9).slope, -std::tan(glide), 1e-6);
  EXPECT_NEAR(slope.at(0.0).slope, -std::tan(glide) * 0.15 / 1.15, 1e-9);
  for (double x = flare_at_m + 5.0; x > -20.0; x -= 0.5) {
    if (std::abs(x - flare_at_m) < 0.3) continue;  // where the curvature sets in
    const double rise = slope.at(x - 0.25).height_m - slope.at(x + 0.25).height_m;
    ASSERT_NEAR(rise / 0.5, slope.at(x).slope, 1e-4) << x;
  }
  EXPECT_GT(slope.at(-1e4).height_m, 6.0);
}

}  // namespace
}  // namespace vinerow::test::air_legs_test
