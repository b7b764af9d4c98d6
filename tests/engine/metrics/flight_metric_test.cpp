/// Metrics of a flight whose way home crosses above its rows, with values computed by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/flight.h"
#include "engine/api/plan_stretch.h"
#include "engine/math/angles.h"
#include "engine/metrics/flight_metric.h"
#include "engine/metrics/path_deviation.h"
#include "engine/metrics/travel.h"
#include "engine/metrics/wheel_slip.h"
#include "tests/support/no_alloc.h"
#include "tests/support/plain_scene.h"

namespace vinerow::metrics::flight_metrics_test {
namespace {

using Eigen::Vector3d;
using Results = std::map<std::string, double>;

constexpr double kRise = 0.1;

/// Ground that rises by 10 % to the east, and a canopy of 2 m on it where 4 < y < 5.
test::PlainScene slope_with_a_row() {
  test::PlainScene scene(test::GroundPlane{.rise_x = kRise});
  scene.panels.push_back(
      {{0.0, 4.5, 2.0}, Vector3d(-kRise, 0.0, 1.0).normalized(), SurfaceClass::kCanopy, 0.5});
  return scene;
}

/// Is wrecked once `crash_` has a text.
class Craft final : public Vehicle {
 public:
  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld&, const Pose&) override {}
  void connect(Ports&) override {}
  void actuate(std::span<const double>) override {}
  void before_physics(Time, Duration) override {}
  void after_physics(Time, Duration) override {}
  void read_truth(Odometry&) const override {}
  Vector3d specific_force_B() const override { return {0, 0, 9.8}; }
  std::string_view crash() const override { return crash_; }
  void read_links(std::vector<Pose>&) const override {}
  void publish(Time) override {}

  std::string crash_;

 private:
  VehicleDescription description_;
  std::vector<VehicleLink> links_;
};

PathPoint point(const Vector3d& p_W, PathKind kind, int alley = -1) {
  PathPoint result;
  result.p_W = p_W;
  result.kind = kind;
  result.alley = alley;
  return result;
}

/// On the slope: up to 1.5 m at home (0, 0), two legs of 20 m, east at y = 2, west at
/// y = 7, with a turn between them; then up, a detour to (20, 9) and 3 m above the ground
/// diagonally across both legs back to home, and down. The climb is part of the way home.
PlannedPath two_rows_and_home() {
  const auto above = [](double x, double y, double height_m) {
    return Vector3d(x, y, kRise * x + height_m);
  };
  PlannedPath path;
  path.points = {point(above(0, 0, 0), PathKind::kVertical),
                 point(above(0, 0, 1.5), PathKind::kTransit)};
  for (int i = 0; i <= 20; ++i) {
    path.points.push_back(
        point(above(5 + i, 2, 1.5), i < 20 ? PathKind::kLeg : PathKind::kTurn, i < 20 ? 0 : -1));
  }
  for (int i = 20; i >= 0; --i) {
    path.points.push_back(
        point(above(5 + i, 7, 1.5), i > 0 ? PathKind::kLeg : PathKind::kReturn, i > 0 ? 1 : -1));
  }
  // From the end of the second leg away to the far side, then home across both rows.
  path.points.push_back(point(above(5, 7, 3), PathKind::kReturn));
  path.points.push_back(point(above(20, 9, 3), PathKind::kReturn));
  path.points.push_back(point(above(0, 0, 3), PathKind::kVertical));
  path.points.push_back(point(above(0, 0, 0), PathKind::kVertical));
  return path;
}

class FlightBench : public ::testing::Test {
 protected:
  using Make = std::unique_ptr<Metric> (*)(const ParameterSet&, const MetricContext&);

  FlightBench() {
    description_.rotorcraft.emplace();
    description_.height_above_ground_m = 0.2;
    description_.actuators = {{"rotor_1_speed_radps", "rad/s", 0, 100},
                              {"rotor_2_speed_radps", "rad/s", 0, 100}};
    Ports ports(bus_, "drone", "test");
    truth_out_ = ports.write<Odometry>("truth");
    plan_out_ = ports.write<PlannedPath>("plan");
    reference_out_ = ports.write<ReferenceTrajectory>("reference");
    actuators_out_ = ports.write<NamedValues>("actuators");
    follower_out_ = ports.write<FollowerState>("follower");
    rotors(50, 50);
  }
  void start(Make make) {
    MetricContext context;
    context.vehicle_description = &description_;
    context.scene = &scene_;
    context.vehicle_truth = &craft_;
    metric_ = make({}, context);
    Ports ports(bus_, "drone", "drone.metrics.test");
    metric_->connect(ports);
    plan_out_.write(now_, two_rows_and_home());
  }
  /// @param height_m  above the ground
  void fly(double x, double y, double height_m, double speed_mps = 3.0, double tilt_rad = 0.0) {
    now_ = now_ + Duration{50'000'000};
    Odometry truth;
    truth.X_WB.p = {x, y, kRise * x + height_m};
    truth.X_WB.q = Eigen::Quaterniond(Eigen::AngleAxisd(tilt_rad, Vector3d::UnitY()));
    truth.v_WB_B = {speed_mps, 0, 0};
    truth_out_.write(now_, truth);
    metric_->step(now_);
  }
  void refer(double speed_mps, double acceleration_mps2) {
    ReferenceTrajectory reference;
    reference.points.resize(2);
    reference.points[0].v_W = {speed_mps, 0, 0};
    reference.points[0].a_W = {acceleration_mps2, 5, 0};  // a bend costs no speed
    reference.points[1].v_W = {7, 0, 0};
    reference_out_.write(now_, reference);
  }
  void rotors(double first_radps, double second_radps) {
    actuators_out_.write(
        now_, {{"rotor_1_speed_radps", "rotor_2_speed_radps"}, {first_radps, second_radps}});
  }
  double result(const std::string& name) const { return metric_->results().at(name); }

  VehicleDescription description_;
  test::PlainScene scene_ = slope_with_a_row();
  Craft craft_;
  SignalBus bus_;
  Time now_;
  std::unique_ptr<Metric> metric_;
  SignalWriter<Odometry> truth_out_;
  SignalWriter<PlannedPath> plan_out_;
  SignalWriter<ReferenceTrajectory> reference_out_;
  SignalWriter<NamedValues> actuators_out_;
  SignalWriter<FollowerState> follower_out_;
};

TEST(PlanStretch, AWayHomeAboveTheRowsIsNotTakenForTheRows) {
  SignalBus bus;
  auto out = bus.advertise<PlannedPath>("drone/plan", "test");
  PlanStretch plan;
  Ports ports(bus, "drone", "reader");
  plan.connect(ports);
  out.write(Time{}, two_rows_and_home());
  ASSERT_TRUE(plan.take_over());
  const auto kind_at = [&](const Vector3d& p_W) {
    return plan.points()[plan.find(p_W).segment].kind;
  };
  // The way home from (20, 9) to (0, 0) crosses the legs at x = 15.56 (y = 7) and 4.44 (y = 2).
  EXPECT_EQ(kind_at({15.556, 7, 1.5556 + 3.0}), PathKind::kReturn);
  EXPECT_EQ(kind_at({15.556, 7, 1.5556 + 1.5}), PathKind::kLeg);
  EXPECT_EQ(kind_at({15.556, 7, 1.5556 + 1.9}), PathKind::kLeg) << "0.4 m too high";
  // Below a place of the way home that crosses no row.
  EXPECT_EQ(kind_at({10, 4.5, 1.0 + 2.8}), PathKind::kReturn);
  // Take-off, way to the first row, landing: one place in the plane.
  EXPECT_EQ(kind_at({0.01, 0, 0.7}), PathKind::kVertical);
  EXPECT_EQ(kind_at({1, 0.4, 1.6}), PathKind::kTransit);
  EXPECT_EQ(kind_at({0, 0, 2.5}), PathKind::kVertical);

  // In the row: 0.3 m beside and 0.4 m above the plan.
  const PlanStretch::Place place = plan.find({10.25, 2.3, 1.025 + 1.9});
  EXPECT_EQ(place.segment, 2 + 5);
  EXPECT_NEAR(place.lateral_m, 0.3, 1e-12);
  EXPECT_NEAR(place.fraction, 0.25, 1e-12);
  EXPECT_NEAR(place.plan_z_m, 1.025 + 1.5, 1e-12);
  // From a line that rises by 1 in 10, the height's part of the distance is 0.4 / sqrt(1.01).
  EXPECT_NEAR(place.distance_m, std::hypot(0.3, 0.4 / std::sqrt(1.01)), 1e-12);
}

TEST(PlanStretch, PlansOnTheGroundAreJudgedInThePlane) {
  SignalBus bus;
  auto out = bus.advertise<PlannedPath>("rover/plan", "test");
  PlanStretch plan;
  Ports ports(bus, "rover", "reader");
  plan.connect(ports);
  PlannedPath path;
  // The second leg lies 10 m higher, as the map says; the vehicle's origin is in between.
  path.points = {point({0, 0, 0}, PathKind::kLeg, 0), point({10, 0, 0}, PathKind::kTurn),
                 point({10, 2, 10}, PathKind::kLeg, 1), point({0, 2, 10}, PathKind::kLeg, 1)};
  out.write(Time{}, path);
  ASSERT_TRUE(plan.take_over());
  const PlanStretch::Place place = plan.find({5, 0.25, 9.0});
  EXPECT_EQ(place.segment, 0);
  EXPECT_DOUBLE_EQ(place.distance_m, 0.25);
  EXPECT_DOUBLE_EQ(place.lateral_m, 0.25);
}

TEST_F(FlightBench, HeightIsJudgedOnTheLegsOnly) {
  start(make_flight);
  EXPECT_TRUE(std::isnan(result("altitude_error_rms_m")));
  fly(0, 0, 0.9);     // taking off
  fly(10, 2, 1.6);    // first leg
  fly(15.5, 7, 1.2);  // second leg
  fly(12, 5.4, 3.7);  // on the way home
  EXPECT_NEAR(result("altitude_error_max_m"), 0.3, 1e-12);
  EXPECT_NEAR(result("altitude_error_rms_m"), std::sqrt((0.01 + 0.09) / 2), 1e-12);
  EXPECT_NEAR(result("height_above_ground_min_m"), 1.2, 1e-12);
  EXPECT_NEAR(result("height_above_ground_max_m"), 1.6, 1e-12);
}

TEST_F(FlightBench, AHoverIsJudgedByItsDistanceFromTheWantedPlace) {
  start(make_flight);
  const auto want = [&](ReferenceTrajectory::Phase phase) {
    ReferenceTrajectory reference;
    reference.phase = phase;
    reference.points.resize(2);
    reference.points[0].p_W = {10, 2, 3.0};  // 2 m above the ground there
    reference.points[1].p_W = {90, 90, 90};
    reference_out_.write(now_, reference);
  };
  want(ReferenceTrajectory::Phase::kTransit);
  fly(10, 2, 1.0);  // not there yet
  EXPECT_TRUE(std::isnan(result("hover_error_max_m")));
  want(ReferenceTrajectory::Phase::kHover);
  fly(10, 2.3, 2.0);
  fly(10, 1.6, 2.3);
  EXPECT_NEAR(result("hover_error_max_m"), 0.5, 1e-12);
  EXPECT_NEAR(result("hover_error_rms_m"), std::sqrt((0.09 + 0.25) / 2), 1e-12);
}

TEST_F(FlightBench, APlanForTheGroundTellsNoHeight) {
  start(make_flight);
  PlannedPath rows;
  rows.points = {point({0, 2, 0}, PathKind::kLeg, 0), point({20, 2, 2}, PathKind::kLeg, 0)};
  plan_out_.write(now_, rows);
  fly(10, 2, 1.6);
  EXPECT_TRUE(std::isnan(result("altitude_error_max_m")));
  EXPECT_NEAR(result("height_above_ground_max_m"), 1.6, 1e-12);
}

TEST_F(FlightBench, TheWayHomeIsClearOfTheCanopy) {
  start(make_flight);
  fly(10, 2, 1.6);
  EXPECT_TRUE(std::isnan(result("return_clearance_min_m")));
  fly(5, 7, 2.0);  // climbs
  EXPECT_TRUE(std::isnan(result("return_clearance_min_m")));
  fly(14, 6.3, 3.2);
  EXPECT_NEAR(result("return_clearance_min_m"), 3.2, 1e-12);
  fly(10, 4.5, 2.9);  // above the row of 2 m
  EXPECT_NEAR(result("return_clearance_min_m"), 0.9, 1e-12);
  fly(5, 2.25, 3.1);
  EXPECT_NEAR(result("return_clearance_min_m"), 0.9, 1e-12);
}

TEST_F(FlightBench, SpeedIsComparedWhereTheReferenceKeepsItsOwn) {
  start(make_flight);
  fly(8, 2, 1.5, 1.0);
  EXPECT_TRUE(std::isnan(result("row_speed_error_max_mps"))) << "no reference yet";
  refer(2.0, 1.0);
  fly(9, 2, 1.5, 1.0);  // it still speeds up
  EXPECT_TRUE(std::isnan(result("row_speed_error_max_mps")));
  refer(3.0, 0.05);
  fly(10, 2, 1.5, 2.75);
  EXPECT_NEAR(result("row_speed_error_max_mps"), 0.25, 1e-12);
  fly(25, 4.5, 1.5, 1.0);  // in the turn
  EXPECT_NEAR(result("row_speed_error_max_mps"), 0.25, 1e-12);
  fly(15, 7, 1.5, 3.4);
  EXPECT_NEAR(result("row_speed_error_max_mps"), 0.4, 1e-12);
  EXPECT_NEAR(result("row_speed_mean_mps"), (1.0 + 1.0 + 2.75 + 3.4) / 4, 1e-12);
}

TEST_F(FlightBench, RotorsAtTheirLimitsAreCountedInTheAir) {
  start(make_flight);
  rotors(0, 0);
  fly(0, 0, 0.25);  // 5 cm above where it stands: rotors that rest are at no limit
  EXPECT_TRUE(std::isnan(result("thrust_limit_share")));
  rotors(50, 60);
  fly(0, 0, 0.5);
  rotors(50, 100);  // one at the top
  fly(0, 0, 1.0);
  rotors(0, 60);  // one at the bottom
  fly(5, 2, 1.5);
  rotors(99.99, 60);  // near it
  fly(6, 2, 1.5);
  EXPECT_DOUBLE_EQ(result("thrust_limit_share"), 0.5);
}

TEST_F(FlightBench, TiltIsTheAngleFromTheVerticalInTheAir) {
  start(make_flight);
  fly(7, 2, 0.2, 0.0, 0.5);  // stands on a slope
  fly(8, 2, 1.5, 3.0, 0.1);
  fly(9, 2, 1.5, 3.0, -0.3);
  EXPECT_NEAR(result("tilt_max_deg"), deg_from_rad(0.3), 1e-9);
}

TEST_F(FlightBench, ACrashIsTheLastThatCounts) {
  start(make_flight);
  fly(8, 2, 1.5, 3.0, 0.1);
  EXPECT_EQ(result("crashed"), 0.0);
  craft_.crash_ = "hit the canopy at 3.0 m/s";
  fly(8, 2, 0.1, 0.0, 2.0);  // lies on its back
  EXPECT_EQ(result("crashed"), 1.0);
  EXPECT_NEAR(result("height_above_ground_min_m"), 1.5, 1e-12);
  EXPECT_NEAR(result("tilt_max_deg"), deg_from_rad(0.1), 1e-9);
}

TEST_F(FlightBench, FinishedIsNotWhoCrashed) {
  start(make_travel);
  fly(0, 0, 0.2);
  follower_out_.write(now_, {.finished = true});
  EXPECT_EQ(result("finished"), 1.0);
  craft_.crash_ = "hit the ground at 2.3 m/s";
  EXPECT_EQ(result("finished"), 0.0);
}

TEST_F(FlightBench, OnTheGroundThereIsNoFlightAndInTheAirNoSlip) {
  start(make_wheel_slip);
  fly(8, 2, 1.5);
  EXPECT_TRUE(metric_->results().empty());
  description_.rotorcraft.reset();
  start(make_flight);
  fly(8, 2, 1.5);
  EXPECT_TRUE(metric_->results().empty());
}

TEST_F(FlightBench, NamesItsResultsBeforeTheFirstTick) {
  start(make_flight);
  const Results results = metric_->results();
  EXPECT_EQ(results.size(), flight_results().size());
  for (const ResultSpec& number : flight_results()) {
    EXPECT_EQ(results.count(number.name), 1u) << number.name;
  }
}

TEST_F(FlightBench, DeviationInTheRowsIsSidewaysAndAlleysAreNotCountedFromAbove) {
  start(make_path_deviation);
  // Along the whole way home: no leg, no alley.
  for (int i = 0; i <= 100; ++i) fly(20 - 0.2 * i, 9 - 0.09 * i, 3.0);
  EXPECT_EQ(result("leg_samples"), 0.0);
  EXPECT_EQ(result("alleys_driven"), 0.0);
  EXPECT_NEAR(result("deviation_max_m"), 0.0, 1e-9);
  for (int i = 0; i <= 20; ++i) fly(5 + i, 2.05, 1.3);
  EXPECT_NEAR(result("cross_track_max_m"), 0.05, 1e-12);
  EXPECT_EQ(result("alleys_driven"), 1.0);
  // In space the height counts too.
  EXPECT_NEAR(result("deviation_max_m"), std::hypot(0.05, 0.2), 1.5e-3);
}

TEST_F(FlightBench, AStepAllocatesNothing) {
  start(make_flight);
  fly(5, 2, 1.5);
  const test::AllocationCounter counter;
  for (int i = 1; i < 20; ++i) fly(5 + i, 2, 1.5);
  EXPECT_EQ(counter.count(), 0u);
}

}  // namespace
}  // namespace vinerow::metrics::flight_metrics_test
