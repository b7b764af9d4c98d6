/// Metrics on hand-made signals with values computed by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/sensors.h"
#include "engine/math/angles.h"
#include "engine/metrics/path_deviation.h"
#include "engine/metrics/spread.h"
#include "engine/metrics/travel.h"
#include "engine/metrics/wheel_slip.h"
#include "tests/support/no_alloc.h"

namespace vinerow::metrics::metrics_test {
namespace {

using Results = std::map<std::string, double>;

/// The signals of one vehicle, and one metric that reads them.
class Bench {
 public:
  using Make = std::unique_ptr<Metric> (*)(const ParameterSet&, const MetricContext&);

  Bench() {
    Ports ports(bus_, "rover", "test");
    truth_out_ = ports.write<Odometry>("truth");
    wheels_out_ = ports.write<NamedValues>("wheels");
    plan_out_ = ports.write<PlannedPath>("plan");
    battery_out_ = ports.write<BatteryState>("battery");
  }
  void start(Make make) {
    MetricContext context;
    context.vehicle_description = &vehicle;
    metric_ = make({}, context);
    Ports ports(bus_, "rover", "rover.metrics.test");
    metric_->connect(ports);
    bus_.check_connected();
  }
  /// @param v_mps  forward speed
  void drive(double t_s, const Eigen::Vector2d& p, double v_mps) {
    now_ = Time{} + duration_from_s(t_s);
    Odometry truth;
    truth.X_WB.p = {p.x(), p.y(), 0.0};
    truth.v_WB_B = {v_mps, 0, 0};
    truth_out_.write(now_, truth);
  }
  void wheels(const NamedValues& values) { wheels_out_.write(now_, values); }
  void plan(const PlannedPath& path) { plan_out_.write(now_, path); }
  void energy(double energy_J) {
    BatteryState state;
    state.energy_used_J = energy_J;
    battery_out_.write(now_, state);
  }
  void step() { metric_->step(now_); }
  Results results() const { return metric_->results(); }

  VehicleDescription vehicle;

 private:
  SignalBus bus_;
  Time now_;
  std::unique_ptr<Metric> metric_;
  SignalWriter<Odometry> truth_out_;
  SignalWriter<NamedValues> wheels_out_;
  SignalWriter<PlannedPath> plan_out_;
  SignalWriter<BatteryState> battery_out_;
};

/// 10 m east, then a half circle of `radius_m` to the left in `chords` pieces, then 10 m west.
PlannedPath u_turn(double radius_m, int chords, double curvature_sign = 1.0) {
  PlannedPath path;
  const auto add = [&](double x, double y, PathKind kind, double curvature) {
    PathPoint point;
    point.p_W = {x, y, 0};
    point.kind = kind;
    point.curvature_per_m = curvature;
    path.points.push_back(point);
  };
  add(0, 0, PathKind::kLeg, 0);
  for (int i = 0; i < chords; ++i) {
    const double angle = kPi * i / chords;
    add(10 + radius_m * std::sin(angle), radius_m * (1 - std::cos(angle)), PathKind::kTurn,
        curvature_sign / radius_m);
  }
  add(10, 2 * radius_m, PathKind::kLeg, 0);
  add(0, 2 * radius_m, PathKind::kLeg, 0);
  return path;
}

NamedValues two_wheels(double left_slip, double right_slip, double speed_radps = 5.0) {
  NamedValues values;
  for (const std::string side : {"left", "right"}) {
    values.names.push_back("wheel_" + side + "_speed_radps");
    values.values.push_back(speed_radps);
    values.names.push_back("wheel_" + side + "_load_N");
    values.values.push_back(100.0);
    values.names.push_back("wheel_" + side + "_slip");
    values.values.push_back(side == "left" ? left_slip : right_slip);
    values.names.push_back("wheel_" + side + "_slip_angle_rad");
    values.values.push_back(side == "left" ? 0.03 : -0.04);
  }
  return values;
}

TEST(WheelSlip, IsMeasuredForAllForEachAndInTurns) {
  Bench bench;
  bench.vehicle.wheeled.emplace().wheel_radius_m = 0.2;
  bench.start(make_wheel_slip);
  bench.drive(0.0, {5, 0}, 1.0);
  bench.plan(u_turn(2.0, 20));
  bench.wheels(two_wheels(0.1, -0.3));  // on the first leg
  bench.step();
  bench.drive(0.1, {12, 2}, 1.0);
  bench.wheels(two_wheels(0.2, 0.4));  // the turn's middle
  bench.step();
  const Results r = bench.results();
  EXPECT_DOUBLE_EQ(r.at("slip_rms"), std::sqrt((0.01 + 0.09 + 0.04 + 0.16) / 4));
  EXPECT_DOUBLE_EQ(r.at("slip_max"), 0.4);
  EXPECT_DOUBLE_EQ(r.at("slip_rms_left"), std::sqrt((0.01 + 0.04) / 2));
  EXPECT_DOUBLE_EQ(r.at("slip_max_left"), 0.2);
  EXPECT_DOUBLE_EQ(r.at("slip_rms_right"), std::sqrt((0.09 + 0.16) / 2));
  EXPECT_DOUBLE_EQ(r.at("slip_rms_turn"), std::sqrt((0.04 + 0.16) / 2));
  EXPECT_DOUBLE_EQ(r.at("slip_max_turn"), 0.4);
  EXPECT_DOUBLE_EQ(r.at("slip_angle_rms_rad"), std::sqrt((0.0009 + 0.0016) / 2));
}

TEST(WheelSlip, CountsEachSampleOnceAndLeavesOutWheelsThatStandOrHang) {
  Bench bench;
  bench.vehicle.wheeled.emplace().wheel_radius_m = 0.2;
  bench.start(make_wheel_slip);
  bench.drive(0.0, {0, 0}, 0.049);
  bench.wheels(two_wheels(1.0, 1.0, 0.24));  // rim 0.048 m/s
  bench.step();
  EXPECT_TRUE(std::isnan(bench.results().at("slip_rms")));
  bench.wheels(two_wheels(0.5, 0.5, 0.26));  // rim 0.052 m/s: counts
  bench.step();
  bench.step();  // nothing new
  bench.drive(0.1, {0, 0}, 1.0);
  NamedValues hanging = two_wheels(0.1, 1.0);
  hanging.values[5] = 0.0;  // the right one has no load
  bench.wheels(hanging);
  bench.step();
  const Results r = bench.results();
  EXPECT_DOUBLE_EQ(r.at("slip_rms_left"), std::sqrt((0.25 + 0.01) / 2));
  EXPECT_DOUBLE_EQ(r.at("slip_rms_right"), 0.5);
  EXPECT_TRUE(std::isnan(r.at("slip_rms_turn"))) << "no plan, no turns";
}

TEST(WheelSlip, NamesWheelsBeforeTheySpeakAndIsNotMeasuredWithoutThem) {
  Bench bench;
  bench.vehicle.actuators = {{"axle_front_steer_rad", "rad", -1, 1},
                             {"wheel_fl_speed_radps", "rad/s", -8, 8}};
  bench.start(make_wheel_slip);
  bench.drive(0.0, {0, 0}, 1.0);
  bench.step();
  const Results r = bench.results();
  EXPECT_EQ(r.count("slip_max_fl"), 1u);
  EXPECT_EQ(r.size(), 7u);
  for (const auto& [name, value] : r) EXPECT_TRUE(std::isnan(value)) << name;
}

TEST(WheelSlip, AStepAllocatesNothing) {
  Bench bench;
  bench.start(make_wheel_slip);
  bench.drive(0.0, {0, 0}, 1.0);
  bench.plan(u_turn(2.0, 20));
  const NamedValues values = two_wheels(0.1, 0.2);
  bench.wheels(values);
  bench.step();
  const test::AllocationCounter counter;
  for (int i = 1; i < 20; ++i) {
    bench.drive(0.1 * i, {0.5 * i, 0}, 1.0);
    bench.wheels(values);
    bench.step();
  }
  EXPECT_EQ(counter.count(), 0u);
}

// Radius 1.77 m in chords of 0.25 m: a track 20 mm outside the arc. The chords' sagitta of 4.5 mm
// (r (1 - cos(pi / 44))) does not count.
TEST(PathDeviation, TurnsAreJudgedByTheArcNotByItsChords) {
  constexpr double kRadius_m = 1.77, kOff_m = 0.02;
  constexpr int kChords = 22;
  Bench bench;
  bench.start(make_path_deviation);
  bench.drive(0.0, {5, 0}, 1.0);
  bench.plan(u_turn(kRadius_m, kChords));
  bench.step();
  // Odd multiples of 1/4 chord: never at a point of the polyline.
  for (int i = 1; i < 4 * kChords; i += 2) {
    const double angle = kPi * i / (4.0 * kChords);
    bench.drive(0.1 * i,
                {10 + (kRadius_m + kOff_m) * std::sin(angle),
                 kRadius_m - (kRadius_m + kOff_m) * std::cos(angle)},
                1.0);
    bench.step();
  }
  const Results r = bench.results();
  EXPECT_NEAR(r.at("turn_deviation_rms_m"), kOff_m, 1e-12);
  EXPECT_NEAR(r.at("turn_deviation_max_m"), kOff_m, 1e-12);
  // The polyline is nearer or farther by up to the sagitta: paper B's numbers keep to it.
  EXPECT_NEAR(r.at("deviation_max_m"), kOff_m + 0.75 * kRadius_m * (1 - std::cos(kPi / 44)), 2e-4);
  EXPECT_EQ(r.at("leg_samples"), 1.0);
}

// A plan whose curvature has the wrong sign, or cannot be, or is none: chords count then or the
// arc on the other side, by definition; and beyond the ends of the plan the end counts.
TEST(PathDeviation, CurvatureThatCannotBeFallsBackToTheChord) {
  PlannedPath path;
  for (const double x : {0.0, 1.0}) {
    PathPoint point;
    point.p_W = {x, 0, 0};
    point.kind = PathKind::kTurn;
    point.curvature_per_m = 3.0;  // a circle of diameter 0.67 m through points 1 m apart
    path.points.push_back(point);
  }
  Bench bench;
  bench.start(make_path_deviation);
  bench.drive(0.0, {0.5, 0.25}, 1.0);
  bench.plan(path);
  bench.step();
  EXPECT_DOUBLE_EQ(bench.results().at("turn_deviation_max_m"), 0.25);
  bench.drive(0.1, {1.3, 0.4}, 1.0);  // 0.5 m from the last point
  bench.step();
  EXPECT_DOUBLE_EQ(bench.results().at("turn_deviation_max_m"), 0.5);
  EXPECT_DOUBLE_EQ(bench.results().at("turn_deviation_rms_m"), std::sqrt((0.0625 + 0.25) / 2));
}

TEST(PathDeviation, ArcsToTheRightLieOnTheOtherSide) {
  // A right bend from (0, 0) to (1, 0) with curvature -1/m: centre (0.5, -sqrt(0.75)), top at
  // 1 - sqrt(0.75) above the chord.
  PlannedPath path;
  for (const double x : {0.0, 1.0}) {
    PathPoint point;
    point.p_W = {x, 0, 0};
    point.kind = PathKind::kTurn;
    point.curvature_per_m = -1.0;
    path.points.push_back(point);
  }
  Bench bench;
  bench.start(make_path_deviation);
  bench.drive(0.0, {0.5, 0.0}, 1.0);
  bench.plan(path);
  bench.step();
  EXPECT_NEAR(bench.results().at("turn_deviation_max_m"), 1 - std::sqrt(0.75), 1e-15);
}

// alleys_driven asks for the whole alley: each tenth of the leg.
PlannedPath one_leg(double length_m) {
  PlannedPath path;
  for (const double x : {0.0, length_m}) {
    PathPoint point;
    point.p_W = {x, 0, 0};
    point.kind = x == 0.0 ? PathKind::kLeg : PathKind::kTransit;
    point.alley = x == 0.0 ? 4 : -1;
    path.points.push_back(point);
  }
  return path;
}

/// Along the leg of 20 m in steps of 15 cm. @returns alleys_driven
double drive_leg(const std::vector<std::pair<double, double>>& pieces_m, double step_m = 0.15) {
  Bench bench;
  bench.start(make_path_deviation);
  bench.drive(0.0, {pieces_m.front().first, 0}, 3.0);
  bench.plan(one_leg(20.0));
  double t_s = 0.0;
  for (const auto& [from_m, to_m] : pieces_m) {
    for (double x = from_m; x < to_m + 1e-9; x += step_m) {
      bench.drive(t_s += 0.05, {x, 0.1}, 3.0);
      bench.step();
    }
  }
  return bench.results().at("alleys_driven");
}

TEST(PathDeviation, AnAlleyIsDrivenWhenAllOfItIs) {
  EXPECT_EQ(drive_leg({{0.0, 20.0}}), 1.0);
  EXPECT_EQ(drive_leg({{1.9, 18.1}}), 1.0) << "from its first tenth to its last";
  EXPECT_EQ(drive_leg({{0.0, 17.9}}), 0.0) << "not to its end";
  EXPECT_EQ(drive_leg({{2.1, 20.0}}), 0.0) << "not from its begin";
  EXPECT_EQ(drive_leg({{18.0, 20.0}}), 0.0) << "its end alone";
  EXPECT_EQ(drive_leg({{0.0, 12.0}, {8.0, 20.0}}), 1.0) << "in two goes";
  EXPECT_EQ(drive_leg({{0.0, 20.0}}, 3.9), 1.0) << "looked at every 3.9 m: it passed the rest too";
}

TEST(PathDeviation, CuttingALegShortIsNoAlley) {
  // Out along the alley and back half a metre beside; the vehicle turns back half way.
  PlannedPath path;
  for (const auto& [x, y] :
       {std::pair{0.0, 0.0}, std::pair{20.0, 0.0}, std::pair{20.0, 0.5}, std::pair{0.0, 0.5}}) {
    PathPoint point;
    point.p_W = {x, y, 0};
    point.kind = PathKind::kLeg;
    point.alley = 4;
    path.points.push_back(point);
  }
  for (const double turns_at_m : {10.0, 20.0}) {
    Bench bench;
    bench.start(make_path_deviation);
    bench.drive(0.0, {0, 0}, 3.0);
    bench.plan(path);
    for (double x = 0.0; x < turns_at_m + 1e-9; x += 0.2) {
      bench.drive(x, {x, 0.0}, 3.0);
      bench.step();
    }
    for (double x = turns_at_m; x > -1e-9; x -= 0.2) {
      bench.drive(100.0 - x, {x, 0.5}, 3.0);
      bench.step();
    }
    EXPECT_EQ(bench.results().at("alleys_driven"), turns_at_m == 20.0 ? 1.0 : 0.0);
  }
}

TEST(Spread, KeepsANaN) {
  Spread spread;
  spread.add(-2.0);
  EXPECT_EQ(spread.max_or_nan(), 2.0);
  spread.add(std::numeric_limits<double>::quiet_NaN());
  spread.add(3.0);
  EXPECT_TRUE(std::isnan(spread.max_or_nan()));
  EXPECT_TRUE(std::isnan(spread.rms()));
}

TEST(Travel, TellsPowerBatteryLifeAndDisplacement) {
  Bench bench;
  bench.vehicle.battery_capacity_J = 7.2e6;  // 2 kWh
  bench.start(make_travel);
  // 3 m east, then 4 m north, in 10 s with 2500 J.
  bench.drive(0.0, {1, 1}, 1.0);
  bench.energy(0.0);
  bench.step();
  bench.drive(5.0, {4, 1}, 1.0);
  bench.step();
  bench.drive(10.0, {4, 5}, 1.0);
  bench.energy(2500.0);
  bench.step();
  const Results r = bench.results();
  EXPECT_DOUBLE_EQ(r.at("distance_m"), 7.0);
  EXPECT_DOUBLE_EQ(r.at("displacement_m"), 5.0);
  EXPECT_DOUBLE_EQ(r.at("mean_power_W"), 250.0);
  EXPECT_DOUBLE_EQ(r.at("battery_hours"), 8.0);  // 7.2e6 J / 250 W = 28800 s
}

TEST(Travel, TimeAndEnergyCountFromTheFirstLook) {
  Bench bench;
  bench.vehicle.battery_capacity_J = 7.2e6;
  bench.start(make_travel);
  bench.drive(300.0, {1, 1}, 1.0);
  bench.energy(9000.0);  // used before its phase began
  bench.step();
  bench.drive(310.0, {11, 1}, 1.0);
  bench.energy(11500.0);
  bench.step();
  EXPECT_DOUBLE_EQ(bench.results().at("time_s"), 10.0);
  EXPECT_DOUBLE_EQ(bench.results().at("energy_J"), 2500.0);
  EXPECT_DOUBLE_EQ(bench.results().at("mean_speed_mps"), 1.0);
}

TEST(Travel, TimeIsTheDoubleNearestToItsDecimal) {
  Bench bench;
  bench.start(make_travel);
  bench.drive(0.2, {1, 1}, 1.0);
  bench.step();
  bench.drive(85.0, {11, 1}, 1.0);
  bench.step();
  EXPECT_EQ(bench.results().at("time_s"), 84.8);
}

TEST(Travel, WithoutBatteryOrCapacityDoesNotGuess) {
  Bench without_capacity;
  without_capacity.start(make_travel);
  without_capacity.drive(0.0, {0, 0}, 0.0);
  without_capacity.energy(0.0);
  without_capacity.step();
  without_capacity.drive(10.0, {0, 0}, 0.0);
  without_capacity.energy(1000.0);
  without_capacity.step();
  EXPECT_DOUBLE_EQ(without_capacity.results().at("mean_power_W"), 100.0);
  EXPECT_TRUE(std::isnan(without_capacity.results().at("battery_hours")));

  Bench without_battery;
  without_battery.vehicle.battery_capacity_J = 1e6;
  without_battery.start(make_travel);
  without_battery.drive(10.0, {0, 0}, 0.0);
  without_battery.step();
  EXPECT_TRUE(std::isnan(without_battery.results().at("mean_power_W")));
  EXPECT_TRUE(std::isnan(without_battery.results().at("battery_hours")));
  EXPECT_EQ(without_battery.results().at("displacement_m"), 0.0);
}

TEST(Travel, StandingDriftCountsFromWhereTheSpringsHaveSettled) {
  Bench bench;
  bench.start(make_travel);
  const auto at = [&](double t_s, double x_m, double v_mps) {
    bench.drive(t_s, {x_m, 0}, v_mps);
    bench.step();
    return bench.results().at("standing_drift_m");
  };
  EXPECT_TRUE(std::isnan(at(0.0, 0.0, 0.02)));   // settling
  EXPECT_TRUE(std::isnan(at(1.0, 0.012, 0.0)));  // not yet for 2 s
  EXPECT_EQ(at(2.0, 0.012, 0.0), 0.0);
  EXPECT_DOUBLE_EQ(at(12.0, 0.0125, 0.00005), 0.0005);
  EXPECT_DOUBLE_EQ(at(20.0, 0.052, 0.02), 0.04);  // it slips: still standing, and seen
  EXPECT_DOUBLE_EQ(at(21.0, 0.08, 0.2), 0.04);    // it drives: no more
  EXPECT_DOUBLE_EQ(at(30.0, 5.0, 0.0), 0.04);
  EXPECT_DOUBLE_EQ(at(33.0, 5.0, 0.0), 0.04);   // the next stand has its own place
  EXPECT_DOUBLE_EQ(at(40.0, 5.03, 0.0), 0.04);  // and the largest drift of all is reported
}

}  // namespace
}  // namespace vinerow::metrics::metrics_test
