// The whole controller on exact kinematics: turns, slopes, lags, forms of the law.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"
#include "tests/controllers/four_wheel_steering/steered_loop.h"

namespace vinerow::test::tracking_test {
namespace {

constexpr double kTight_m = 1.77;  // the least the axles allow is 1.767 m

/// The gains of the reference page, without what goes beyond the paper.
const Values kReferenceGains = {{"lateral_gain_rad_per_m", 0.6},
                                {"heading_gain_per_m", 1.2},
                                {"response_s", 0.0},
                                {"slip_learn_s", 0.0}};

Values operator+(Values a, const Values& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Worst over four directions of the rows.
Tracking track_all_directions(double radius_m, const LoopOptions& options) {
  Tracking worst;
  worst.finished = true;
  for (const double heading : {0.0, 0.5 * kPi, kPi, 0.8}) {
    const Tracking run = track(make_omega(radius_m, 2.5, 15.0, heading), options);
    worst.finished = worst.finished && run.finished;
    worst.leg_rms_m = std::max(worst.leg_rms_m, run.leg_rms_m);
    worst.turn_rms_m = std::max(worst.turn_rms_m, run.turn_rms_m);
    worst.max_m = std::max(worst.max_m, run.max_m);
  }
  return worst;
}

TEST(Tracking, DrivesTheTightestOmegaTurn) {
  const Tracking run = track_all_directions(kTight_m, {});
  EXPECT_TRUE(run.finished);
  EXPECT_LT(run.leg_rms_m, 0.002);
  EXPECT_LT(run.turn_rms_m, 0.01);
  EXPECT_LT(run.max_m, 0.02);
}

// Reference page: 0.004 m rms, 0.013 m at most with feed-forward; 0.74 m and 1.9 m without.
TEST(Tracking, NeedsTheFeedForwardOfCurvature) {
  const PlannedPath omega = make_omega(kTight_m);
  const Tracking with = track(omega, {.parameters = kReferenceGains});
  EXPECT_LT(with.rms_m, 0.004);
  EXPECT_LT(with.max_m, 0.013);
  const Tracking without =
      track(omega, {.parameters = kReferenceGains + Values{{"feed_forward", false}}});
  EXPECT_GT(without.rms_m, 0.5);
  EXPECT_GT(without.max_m, 1.0);
}

TEST(Tracking, DivergesAsPrinted) {
  const Tracking printed =
      track(make_omega(kTight_m),
            {.parameters = kReferenceGains + Values{{"form", std::string("printed")}},
             .longest_s = 100.0});
  EXPECT_FALSE(printed.finished);
  EXPECT_GT(printed.max_m, 3.0);
}

TEST(Tracking, ComesBackToThePath) {
  LoopOptions options;
  options.offset_m = {0.0, 0.4};
  options.heading_error_rad = -0.3;
  options.settle_m = 6.0;
  const Tracking run = track(make_straight_plan(15.0), options);
  EXPECT_TRUE(run.finished);
  EXPECT_LT(run.max_m, 1e-3);
}

// 20 deg across: tyres with a slip of 0.14 rad per sin(slope) let the vehicle drift by 2.7 deg. The
// proportional law alone then runs beside the path by slip / K_s.
TEST(Tracking, LearnsTheDriftOfASideSlope) {
  LoopOptions options;
  options.plant.slope_rad = rad_from_deg(20.0);
  options.plant.slip_rad = 0.14;
  options.settle_m = 5.0;
  const double slip = std::atan(0.14 * std::sin(options.plant.slope_rad));
  const PlannedPath contour = make_straight_plan(30.0);
  EXPECT_LT(track(contour, options).max_m, 0.002);
  options.parameters = {{"slip_learn_s", 0.0}};
  const Tracking without = track(contour, options);
  // Seen in plan, hence the cosine.
  EXPECT_NEAR(without.rms_m, slip / 2.0 * std::cos(options.plant.slope_rad), 0.15 * slip / 2.0);
}

// The axles allow 1.767 m; slip and the steeper curves of a slope need some of their range.
TEST(Tracking, KeepsItsAccuracyOnSteepGround) {
  struct Case {
    double slope_deg, radius_m, leg_m, turn_m;
  };
  for (const Case& c : {Case{10.0, kTight_m, 0.005, 0.03},
                        {15.0, kTight_m, 0.01, 0.05},
                        {15.0, 1.9, 0.005, 0.02},
                        {20.0, 1.9, 0.01, 0.05},
                        {20.0, 2.0, 0.005, 0.02}}) {
    LoopOptions options;
    options.plant.slope_rad = rad_from_deg(c.slope_deg);
    options.plant.slip_rad = 0.14;
    const Tracking run = track_all_directions(c.radius_m, options);
    EXPECT_TRUE(run.finished);
    EXPECT_LT(run.leg_rms_m, c.leg_m) << c.slope_deg << " deg, " << c.radius_m << " m";
    EXPECT_LT(run.turn_rms_m, c.turn_m) << c.slope_deg << " deg, " << c.radius_m << " m";
  }
}

TEST(Tracking, BearsLagAndUndersteer) {
  LoopOptions options;
  options.plant.servo_lag_s = 0.05;
  options.plant.yaw_lag_s = 0.1;
  options.plant.turn_share = 0.95;
  for (const bool encoders : {false, true}) {
    options.encoders = encoders;
    const Tracking run = track_all_directions(2.0, options);
    EXPECT_TRUE(run.finished);
    EXPECT_LT(run.leg_rms_m, 0.003);
    EXPECT_LT(run.turn_rms_m, 0.01);
  }
}

/// Root mean square of rim speed less the speed of the wheel's centre along the wheel, in the turn.
double turn_slip_mps(const std::string& speeds) {
  LoopOptions options;
  options.parameters = {{"speeds", speeds}};
  const PlannedPath omega = make_omega(kTight_m);
  SteeredLoop loop(options);
  loop.give_plan(omega);
  double sum = 0.0;
  int count = 0;
  while (!loop.finished() && loop.time_s() < 100.0) {
    loop.tick();
    if (omega.points[loop.follower().waypoint].kind != PathKind::kTurn) continue;
    const Odometry truth = loop.plant().truth();
    const double w = truth.w_WB_B.z(), front = std::tan(loop.plant().front_rad()),
                 rear = std::tan(loop.plant().rear_rad()), k = (front - rear) / 1.5;
    for (int i = 0; i < 4; ++i) {
      const double x = i < 2 ? 0.75 : -0.75, y = i % 2 == 0 ? 0.425 : -0.425;
      const double angle = std::atan((0.5 * (front + rear) + k * x) / (1.0 - k * y));
      const double along = (truth.v_WB_B.x() - w * y) * std::cos(angle) +
                           (truth.v_WB_B.y() + w * x) * std::sin(angle);
      const double slip = 0.2 * loop.actuators()[2 + i] - along;
      sum += slip * slip;
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

TEST(Tracking, SlipsThreeTimesLessWithTheQp) {
  const double equal = turn_slip_mps("equal"), qp = turn_slip_mps("qp");
  EXPECT_GT(equal, 0.1);
  EXPECT_LT(qp, equal / 3.0);
  RecordProperty("equal_mm_per_s", static_cast<int>(1e3 * equal));
  RecordProperty("qp_mm_per_s", static_cast<int>(1e3 * qp));
}

TEST(Tracking, KeepsSpeedsAndStopsAtTheEnd) {
  const PlannedPath omega = make_omega(kTight_m);
  SteeredLoop loop({});
  loop.give_plan(omega);
  double fastest = 0.0, fastest_in_turn = 0.0, last = 0.0;
  while (!loop.finished() && loop.time_s() < 100.0) {
    loop.tick();
    const double v = loop.steering("v_des_mps");
    EXPECT_LE(v - last, 0.5 * 0.02 + 1e-12);
    last = v;
    fastest = std::max(fastest, v);
    const PathPoint& at = omega.points[loop.follower().waypoint];
    if (at.kind == PathKind::kTurn) fastest_in_turn = std::max(fastest_in_turn, v);
  }
  EXPECT_TRUE(loop.finished());
  EXPECT_NEAR(fastest, 1.0, 1e-9);
  EXPECT_LE(fastest_in_turn, 0.8 + 1e-9);
  EXPECT_GT(fastest_in_turn, 0.78);
  EXPECT_NEAR((loop.plant().pose().p - Eigen::Vector2d(0.0, 2.5)).norm(), 0.05, 0.005);
  for (int i = 0; i < 3; ++i) loop.tick();
  for (int i = 2; i < 6; ++i) EXPECT_EQ(loop.actuators()[i], 0.0);
}

}  // namespace
}  // namespace vinerow::test::tracking_test
