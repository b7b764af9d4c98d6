/// Metrics of what has wings, with values computed by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "engine/api/map.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/flight.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/metrics/air_tracking.h"
#include "engine/metrics/flight_metric.h"
#include "engine/metrics/survey_coverage.h"
#include "tests/engine/sensors/sensor_bench.h"
#include "tests/support/no_alloc.h"

namespace vinerow::metrics::air_metrics_test {
namespace {

using Eigen::Vector3d;
using Make = std::unique_ptr<Metric> (*)(const ParameterSet&, const MetricContext&);
using Phase = AirReference::Phase;

PathPoint point(double x, double y, PathKind kind, int alley = -1) {
  PathPoint result;
  result.p_W = {x, y, 150};
  result.kind = kind;
  result.alley = alley;
  return result;
}

class WingBench : public ::testing::Test {
 protected:
  WingBench() {
    description_.fixed_wing.emplace();
    Ports ports(bus_, "plane", "test");
    truth_out_ = ports.write<Odometry>("truth");
    reference_out_ = ports.write<AirReference>("reference");
    deviation_out_ = ports.write<NamedValues>("deviation");
    plan_out_ = ports.write<PlannedPath>("plan");
    shot_out_ = ports.write<CameraShot>("camera");
    world_.rows->boundary_W = {{0, 0}, {100, 0}, {100, 60}, {0, 60}};
  }
  void start(Make make, const PartSpec& spec,
             const std::vector<std::pair<std::string, ParameterSet::Value>>& values = {}) {
    ParameterSet parameters(spec.parameters, spec.name);
    for (const auto& [name, value] : values) parameters.set(name, value);
    MetricContext context;
    context.vehicle_description = &description_;
    context.scene = &scene_;
    context.world = &world_;
    context.vehicle_truth = &vehicle_;
    metric_ = make(parameters, context);
    Ports ports(bus_, "plane", "plane.metrics.test");
    metric_->connect(ports);
  }
  void plan_lanes() {
    PlannedPath path;
    path.points = {point(-100, 0, PathKind::kTransit), point(0, 0, PathKind::kLeg, 0),
                   point(100, 0, PathKind::kTurn),     point(100, 45, PathKind::kLeg, 1),
                   point(0, 45, PathKind::kReturn),    point(-100, 0, PathKind::kReturn)};
    plan_out_.write(now_, path);
  }
  void want(Phase phase, double height_m = 150, double heading_rad = 0, double airspeed_mps = 12) {
    AirReference reference;
    reference.phase = phase;
    reference.height_m = height_m;
    reference.heading_rad = heading_rad;
    reference.airspeed_mps = airspeed_mps;
    reference_out_.write(now_, reference);
  }
  void fly(const Vector3d& p_W, const RollPitchYaw& attitude = {}) {
    now_ = now_ + Duration{50'000'000};
    Odometry truth;
    truth.X_WB = {quaternion_from_rpy(attitude), p_W};
    truth.v_WB_B = {12, 0, 0};
    truth_out_.write(now_, truth);
    metric_->step(now_);
  }
  void deviate(double share, double lon_x, double lon_u, double lat_x, double lat_u) {
    deviation_out_.write(now_, {{"h_m", "limit_share", "outside_lon_states", "outside_lon_inputs",
                                 "outside_lat_states", "outside_lat_inputs"},
                                {99.0, share, lon_x, lon_u, lat_x, lat_u}});
  }
  /// A picture of 100 m along x by 40 m from h = 150 m.
  void shoot(int index, double x, double y) {
    CameraShot shot;
    shot.index = index;
    shot.X_WS = {quaternion_from_rpy({0, kPi / 2, 0}), {x, y, 150}};
    shot.corners_W = {Vector3d(x + 50, y + 20, 0), Vector3d(x + 50, y - 20, 0),
                      Vector3d(x - 50, y - 20, 0), Vector3d(x - 50, y + 20, 0)};
    shot.on_ground = true;
    shot.distance_m = 150;
    shot.gsd_m = 0.1;
    shot_out_.write(now_, shot);
  }
  double result(const std::string& name) const { return metric_->results().at(name); }

  VehicleDescription description_;
  test::PlainScene scene_{test::GroundPlane{}};
  test::FixedVehicle vehicle_;
  WorldModel world_;
  SignalBus bus_;
  Time now_;
  std::unique_ptr<Metric> metric_;
  SignalWriter<Odometry> truth_out_;
  SignalWriter<AirReference> reference_out_;
  SignalWriter<NamedValues> deviation_out_;
  SignalWriter<PlannedPath> plan_out_;
  SignalWriter<CameraShot> shot_out_;
};

TEST_F(WingBench, OnlyTheSurveyIsJudged) {
  start(make_air_tracking, air_tracking_spec());
  fly({0, 0, 170});
  for (const Phase phase :
       {Phase::kWait, Phase::kLaunch, Phase::kLoiter, Phase::kLand, Phase::kDone}) {
    want(phase);
    fly({0, 0, 170});
  }
  EXPECT_TRUE(std::isnan(result("height_error_rms_m")));
  EXPECT_TRUE(std::isnan(result("load_factor_max")));
  want(Phase::kStraight);
  fly({0, 0, 153});
  want(Phase::kTurn);
  fly({0, 0, 146});
  EXPECT_NEAR(result("height_error_rms_m"), std::sqrt((9.0 + 16.0) / 2), 1e-12);
  EXPECT_NEAR(result("height_error_max_m"), 4.0, 1e-12);
}

TEST_F(WingBench, HeadingErrorsAreWrappedAndStraightLegsStandApart) {
  start(make_air_tracking, air_tracking_spec());
  // The reference's heading goes on counting: one whole turn more.
  want(Phase::kStraight, 150, 2 * kPi + kPi - 0.01);
  fly({0, 0, 150}, {0, 0, -kPi + 0.02});
  want(Phase::kTurn, 150, 1.0);
  fly({0, 0, 150}, {0, 0, 1.04});
  EXPECT_NEAR(result("straight_heading_error_rms_deg"), deg_from_rad(0.03), 1e-9);
  EXPECT_NEAR(result("heading_error_rms_deg"), deg_from_rad(std::sqrt((9e-4 + 16e-4) / 2)), 1e-9);
}

TEST_F(WingBench, CrossTrackIsOfTheLegsWhileStraight) {
  start(make_air_tracking, air_tracking_spec());
  plan_lanes();
  want(Phase::kStraight);
  fly({-50, 7, 150});  // on the way to the first lane
  EXPECT_TRUE(std::isnan(result("straight_cross_track_max_m")));
  fly({50, 0.6, 152});
  fly({40, 45.8, 150});
  want(Phase::kTurn);
  fly({60, 5, 150});
  EXPECT_NEAR(result("straight_cross_track_max_m"), 0.8, 1e-12);
  EXPECT_NEAR(result("straight_cross_track_rms_m"), std::sqrt((0.36 + 0.64) / 2), 1e-12);
}

TEST_F(WingBench, AirspeedBankAndLoadFactor) {
  start(make_air_tracking, air_tracking_spec());
  want(Phase::kTurn);
  vehicle_.air_velocity = {12.4, 0, 0};
  vehicle_.specific_force = {0, 0, 9.80665 * 1.2};
  fly({0, 0, 150}, {-0.6, 0.1, 2.0});
  vehicle_.air_velocity = {11.0, 0, -1.0};
  vehicle_.specific_force = {0, 0, 9.80665};
  fly({0, 0, 150}, {0.5, 0, 0});
  EXPECT_NEAR(result("airspeed_error_rms_mps"),
              std::sqrt((0.16 + std::pow(std::sqrt(122.0) - 12, 2)) / 2), 1e-12);
  EXPECT_NEAR(result("bank_max_deg"), deg_from_rad(0.6), 1e-9);
  EXPECT_NEAR(result("load_factor_max"), 1.2, 1e-12);
}

TEST_F(WingBench, TicksOutsideTheLimitsAreCountedOnce) {
  start(make_air_tracking, air_tracking_spec());
  want(Phase::kLaunch);
  deviate(3.0, 1, 1, 1, 1);
  fly({0, 0, 150});
  EXPECT_TRUE(std::isnan(result("limit_steps_lon_states")));
  want(Phase::kStraight);
  deviate(0.7, 0, 0, 0, 0);
  fly({0, 0, 150});
  deviate(1.2, 1, 0, 0, 1);
  fly({0, 0, 150});
  fly({0, 0, 150});  // the same deviation
  deviate(1.1, 1, 0, 0, 0);
  fly({0, 0, 150});
  EXPECT_EQ(result("limit_steps_lon_states"), 2);
  EXPECT_EQ(result("limit_steps_lon_inputs"), 0);
  EXPECT_EQ(result("limit_steps_lat_states"), 0);
  EXPECT_EQ(result("limit_steps_lat_inputs"), 1);
  EXPECT_NEAR(result("limit_share_max"), 1.2, 1e-12);
}

TEST_F(WingBench, ResultsAreNamedBeforeTheFirstTick) {
  const auto check = [&](Make make, const PartSpec& spec, const std::vector<ResultSpec>& numbers) {
    start(make, spec);
    const auto results = metric_->results();
    EXPECT_EQ(results.size(), numbers.size());
    for (const ResultSpec& number : numbers) {
      EXPECT_TRUE(results.contains(number.name)) << number.name;
    }
  };
  check(make_air_tracking, air_tracking_spec(), air_tracking_results());
  check(make_survey_coverage, survey_coverage_spec(), coverage_results());
}

TEST_F(WingBench, WithoutWingsThereAreNoSuchResults) {
  description_.fixed_wing.reset();
  description_.rotorcraft.emplace();
  SignalBus bus;
  Ports ports(bus, "drone", "test");
  ports.write<Odometry>("truth");
  ports.write<ReferenceTrajectory>("reference");  // another type
  for (const auto& [make, spec] :
       {std::pair<Make, PartSpec>{make_air_tracking, air_tracking_spec()},
        {make_survey_coverage, survey_coverage_spec()}}) {
    start(make, spec);
    EXPECT_NO_THROW(metric_->connect(ports));
    fly({0, 0, 150});
    EXPECT_TRUE(metric_->results().empty());
  }
}

TEST_F(WingBench, FlightDoesNotReadTheReferenceOfWings) {
  start(make_flight, flight_spec());  // connecting would throw: the reference is of another type
  plan_lanes();
  want(Phase::kStraight);
  fly({50, 0.6, 152}, {0.3, 0, 0});
  const auto results = metric_->results();
  EXPECT_NEAR(results.at("altitude_error_max_m"), 2.0, 1e-12);
  EXPECT_NEAR(results.at("height_above_ground_min_m"), 152.0, 1e-12);
  EXPECT_NEAR(results.at("tilt_max_deg"), deg_from_rad(0.3), 1e-9);
  EXPECT_FALSE(results.contains("hover_error_rms_m"));
  EXPECT_FALSE(results.contains("thrust_limit_share"));
}

TEST_F(WingBench, PicturesOfTheLanesCoverTheParcel) {
  start(make_survey_coverage, survey_coverage_spec());
  plan_lanes();
  fly({-60, 0, 150});
  shoot(0, -60, 0);  // on the way: shows the parcel's edge no more
  fly({-60, 0, 150});
  for (int i = 0; i < 5; ++i) {
    shoot(i + 1, 20 * i, 0);
    fly({20.0 * i, 0, 150});
    fly({20.0 * i + 10, 0, 150});  // the picture of before
  }
  for (int i = 0; i < 5; ++i) {
    shoot(i + 7, 80 - 20 * i, 40);
    fly({80 - 20.0 * i, 45, 150}, {0, 0, kPi});
  }
  EXPECT_EQ(result("shots"), 11);
  EXPECT_NEAR(result("forward_overlap_min"), 0.8, 1e-12);
  EXPECT_NEAR(result("gsd_mean_m"), 0.1, 1e-12);
  // Lanes 40 m apart with pictures 40 m wide: side by side.
  EXPECT_NEAR(result("side_overlap_mean"), 0.0, 1e-12);
  // All of the parcel of 60 m is seen; by pairs what they have in common, from x = -30 to 110.
  EXPECT_EQ(result("covered_share"), 1.0);
  EXPECT_EQ(result("overlap_covered_share"), 0.0) << "80 %, not 85 %";
}

TEST_F(WingBench, TheParcelMayBeGiven) {
  start(make_survey_coverage, survey_coverage_spec(),
        {{"polygon_x_m", std::vector<double>{-50, 50, 50, -50}},
         {"polygon_y_m", std::vector<double>{-20, -20, 60, 60}},
         {"wanted_overlap", 0.5}});
  shoot(0, 0, 0);
  fly({0, 0, 150});
  EXPECT_DOUBLE_EQ(result("covered_share"), 0.5);
}

TEST_F(WingBench, RefusesParcelsThatAreNone) {
  const auto refuse = [&](const std::vector<double>& x, const std::vector<double>& y,
                          const std::string& sentence) {
    try {
      start(make_survey_coverage, survey_coverage_spec(), {{"polygon_x_m", x}, {"polygon_y_m", y}});
      FAIL() << "not refused: " << sentence;
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.what(), sentence);
    }
  };
  refuse({0, 1, 1}, {0, 0}, "polygon_x_m has 3 numbers and polygon_y_m has 2, must be as many");
  refuse({0, 1}, {0, 0}, "the parcel has 2 corners, must be at least 3");
}

TEST_F(WingBench, AStepAllocatesNothing) {
  for (const auto& [make, spec] :
       {std::pair<Make, PartSpec>{make_air_tracking, air_tracking_spec()},
        {make_survey_coverage, survey_coverage_spec()}}) {
    start(make, spec);
    plan_lanes();
    want(Phase::kStraight);
    deviate(0.5, 0, 0, 0, 0);
    shoot(0, 0, 0);
    fly({0, 0, 150});
    const test::AllocationCounter counter;
    for (int i = 1; i < 20; ++i) {
      shoot(i, 5 * i, 0);
      fly({5.0 * i, 0, 150});
    }
    EXPECT_EQ(counter.count(), 0u);
  }
}

}  // namespace
}  // namespace vinerow::metrics::air_metrics_test
