/// Where sections open and close: row ends, outer rows, turns, halts, legs, lags, errors of the
/// estimate.

#include "vehicles/payloads/section_switch.h"

#include <gtest/gtest.h>

#include "tests/vehicles/payloads/payload_rig.h"

namespace vinerow::vehicles::section_switch_test {
namespace {

using namespace test;

struct Stretch {
  double from_x_m = 1e9;
  double to_x_m = -1e9;
};

/// Where the left section is open on a pass along rows from 0 to 20 m.
Stretch open_stretch(const PayloadValues& values, double speed_mps,
                     double estimate_error_x_m = 0.0) {
  PayloadRig rig("sprayer", make_box_rows({{.y_m = 1.25}}), values);
  Stretch stretch;
  for (double x = -3.0; x < 23.0; x += speed_mps * rig.period.s()) {
    rig.tick(x, 0.0, 0.0, speed_mps, estimate_error_x_m);
    if (rig.signal_value("left_on") == 0.0) continue;
    stretch.from_x_m = std::min(stretch.from_x_m, x);
    stretch.to_x_m = std::max(stretch.to_x_m, x);
  }
  return stretch;
}

TEST(LaggingValve, FollowsLateAndForgetsWhatIsTakenBack) {
  LaggingValve valve;
  const Duration lag{300'000'000};
  EXPECT_FALSE(valve.follow(true, Time{0}, lag));
  EXPECT_FALSE(valve.follow(true, Time{299'000'000}, lag));
  EXPECT_TRUE(valve.follow(true, Time{300'000'000}, lag));
  EXPECT_TRUE(valve.follow(false, Time{400'000'000}, lag));
  EXPECT_TRUE(valve.follow(true, Time{500'000'000}, lag));
  EXPECT_TRUE(valve.follow(true, Time{900'000'000}, lag));
  EXPECT_TRUE(valve.follow(false, Time{1'000'000'000}, lag));
  EXPECT_FALSE(valve.follow(false, Time{1'300'000'000}, lag));
}

// The boom is 0.6 m behind B's origin, a tick is 0.05 m at 1 m/s.
TEST(SectionSwitch, OpensAtARowsBeginAndClosesAtItsEnd) {
  const Stretch stretch = open_stretch({}, 1.0);
  EXPECT_NEAR(stretch.from_x_m, 0.6, 0.051);
  EXPECT_NEAR(stretch.to_x_m, 20.6, 0.051);
}

TEST(SectionSwitch, WithoutALeadTheValvesLagIsLate) {
  const Stretch stretch = open_stretch({{"lead_s", 0.0}, {"valve_lag_s", 0.4}}, 1.0);
  EXPECT_NEAR(stretch.from_x_m, 1.0, 0.051);
  EXPECT_NEAR(stretch.to_x_m, 21.0, 0.051);
}

TEST(SectionSwitch, GoesOnBeyondOrStopsBeforeTheEnd) {
  const Stretch longer = open_stretch({{"beyond_end_m", 0.5}}, 1.0);
  EXPECT_NEAR(longer.from_x_m, 0.1, 0.051);
  EXPECT_NEAR(longer.to_x_m, 21.1, 0.051);
  const Stretch shorter = open_stretch({{"beyond_end_m", -0.5}}, 1.0);
  EXPECT_NEAR(shorter.from_x_m, 1.1, 0.051);
  EXPECT_NEAR(shorter.to_x_m, 20.1, 0.051);
}

TEST(SectionSwitch, KnowsTheEstimateNotTheTruth) {
  // It believes to be 1 m farther than it is.
  const Stretch stretch = open_stretch({}, 1.0, 1.0);
  EXPECT_NEAR(stretch.from_x_m, -0.4, 0.051);
  EXPECT_NEAR(stretch.to_x_m, 19.6, 0.051);
  PayloadRig rig("sprayer", make_box_rows({{.y_m = 1.25}}));
  rig.pass(-3.0, 23.0, 0.0, 1.0, 1.0);
  // A metre before the row: four nozzles of 0.231 l/min for a second.
  EXPECT_NEAR(rig.result("litres_off_row"), 4.0 * 0.2309 / 60.0, 0.051 * 4.0 * 0.2309 / 60.0);
}

TEST(SectionSwitch, KnowsTheMapNotTheTruth) {
  const RowMap map = make_box_rows({{.y_m = -1.25}}).rows;
  PayloadRig rig("sprayer", make_box_rows({{.y_m = 1.25}}), {}, 1, &map);
  rig.pass(2.0, 10.0, 0.0, 1.0);
  EXPECT_EQ(rig.signal_value("left_on"), 0.0);
  EXPECT_EQ(rig.signal_value("right_on"), 1.0);
  EXPECT_EQ(rig.result("litres_off_row"), rig.result("litres_sprayed"));
}

TEST(SectionSwitch, LeftAndRightAreApart) {
  PayloadRig rig("sprayer", make_box_rows({{.y_m = 1.25}, {.y_m = -1.25, .from_x_m = 10.0}}));
  rig.pass(5.0, 6.0, 0.0, 1.0);
  EXPECT_EQ(rig.signal_value("left_on"), 1.0);
  EXPECT_EQ(rig.signal_value("right_on"), 0.0);
  rig.pass(12.0, 13.0, 0.0, 1.0);
  EXPECT_EQ(rig.signal_value("left_on"), 1.0);
  EXPECT_EQ(rig.signal_value("right_on"), 1.0);
  rig.pass(6.0, 5.0, 0.0, 1.0);
  EXPECT_EQ(rig.signal_value("left_on"), 0.0);
  EXPECT_EQ(rig.signal_value("right_on"), 1.0);
}

TEST(SectionSwitch, ClosesInTurnsAndAtAHalt) {
  PayloadRig rig("sprayer", make_box_rows({{.y_m = 1.25}, {.y_m = -1.25}}));
  const auto open_after = [&](double yaw_rad, double speed_mps) {
    for (int i = 0; i < 20; ++i) rig.tick(10.0, 0.0, yaw_rad, speed_mps);
    return rig.signal_value("left_on") + rig.signal_value("right_on");
  };
  EXPECT_EQ(open_after(0.0, 1.0), 2.0);
  EXPECT_EQ(open_after(rad_from_deg(45.0), 1.0), 0.0);
  EXPECT_EQ(open_after(rad_from_deg(10.0), 1.0), 2.0);
  EXPECT_EQ(open_after(0.0, 0.1), 0.0);
  EXPECT_EQ(open_after(0.0, -1.0), 2.0);  // backwards
  EXPECT_EQ(open_after(0.0, 0.0), 0.0);
}

TEST(SectionSwitch, OnLegsOnlyWhereThePlanHasOne) {
  PayloadRig rig("sprayer", make_box_rows({{.y_m = 1.25}}), {{"switching", std::string("legs")}});
  rig.pass(1.0, 5.0, 0.0, 1.0);
  EXPECT_EQ(rig.signal_value("left_on"), 0.0) << "without a plan";
  PlannedPath plan;
  plan.points.resize(3);
  plan.points[0].kind = PathKind::kLeg;
  plan.points[1].p_W = {10, 0, 0};
  plan.points[1].kind = PathKind::kTransit;
  plan.points[2].p_W = {20, 0, 0};
  rig.plan.write(rig.now, plan);
  rig.pass(1.0, 5.0, 0.0, 1.0);
  EXPECT_EQ(rig.signal_value("left_on"), 1.0);
  rig.pass(11.0, 15.0, 0.0, 1.0);
  EXPECT_EQ(rig.signal_value("left_on"), 0.0);
}

}  // namespace
}  // namespace vinerow::vehicles::section_switch_test
