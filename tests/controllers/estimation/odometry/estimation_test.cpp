#include <gtest/gtest.h>

#include <cmath>

#include "controllers/estimation/odometry/odometry_kalman.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/sensors.h"
#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/mission.h"

namespace vinerow::test::estimation_test {
namespace {

using Text = std::string;

/// An estimator between signals that a test writes by hand. Tick: 25 ms.
class Bench {
 public:
  explicit Bench(const PartChoice& choice, std::uint64_t seed = 1,
                 std::vector<SensorMounting> sensors = {})
      : description_(make_rover_description()) {
    Ports world(bus_, "rover", "test");
    truth = world.write<Odometry>("truth");
    gps = world.write<GnssFix>("gps");
    imu = world.write<ImuSample>("imu");
    command = world.write<VelocityCommand>("command");
    wheels = world.write<NamedValues>("wheels");
    estimate = world.read<Odometry>("estimate");
    EstimatorContext context;
    context.vehicle = "rover";
    context.part = "rover.estimator";
    context.seed = seed;
    context.period = period;
    context.vehicle_description = &description_;
    context.sensors = std::move(sensors);
    const PartSpec& spec = parts().spec(PartKind::kEstimator, choice.type);
    estimator_ = parts().make_estimator(choice.type, make_parameters(spec, choice.values), context);
    Ports ports(bus_, "rover", "rover.estimator");
    estimator_->connect(ports);
  }

  void write_truth(const Eigen::Vector3d& p, const RollPitchYaw& rpy = {}) {
    Odometry odometry;
    odometry.X_WB = {quaternion_from_rpy(rpy), p};
    truth.write(now, odometry);
  }
  void write_fix(const Eigen::Vector3d& p, Time measured, const Eigen::Vector3d& v = {0, 0, 0},
                 bool valid = true) {
    GnssFix fix;
    fix.valid = valid;
    fix.p_W = p;
    fix.v_W = v;
    fix.std_m.setConstant(0.01);
    gps.write(measured, fix);
  }
  void give_pose(const Odometry& pose) {
    static_cast<Signal<Odometry>*>(bus_.find("rover/initialpose"))->write(now, pose);
  }
  std::string event_text() {
    return bus_.subscribe<Event>("rover/estimator_event", "test").value().text;
  }
  void tick() {
    estimator_->step(now);
    now = now + period;
  }

  Duration period{25'000'000};
  Time now;
  SignalWriter<Odometry> truth;
  SignalWriter<GnssFix> gps;
  SignalWriter<ImuSample> imu;
  SignalWriter<VelocityCommand> command;
  SignalWriter<NamedValues> wheels;
  SignalReader<Odometry> estimate;

 private:
  VehicleDescription description_;
  SignalBus bus_;
  std::unique_ptr<Estimator> estimator_;
};

TEST(GpsPose, TakesTheFixAndTheTrueHeading) {
  Bench bench({"gps_pose", {{"heading", Text("truth")}}});
  bench.write_truth({1, 2, 0.3}, {0, 0, 0.7});
  bench.tick();
  EXPECT_FALSE(bench.estimate.has_value());  // no fix yet
  bench.write_fix({1.02, 1.99, 0.3}, bench.now);
  bench.tick();
  EXPECT_EQ(bench.estimate.value().X_WB.p, Eigen::Vector3d(1.02, 1.99, 0.3));
  EXPECT_NEAR(yaw_from_quaternion(bench.estimate.value().X_WB.q), 0.7, 1e-12);
  // Held until the next valid fix.
  bench.write_fix({9, 9, 9}, bench.now, {0, 0, 0}, false);
  bench.tick();
  EXPECT_EQ(bench.estimate.value().X_WB.p.x(), 1.02);
}

TEST(GpsPose, TakesOffTheAntennasArmOnASlope) {
  const RollPitchYaw rpy = {0.1, -0.2, 0.9};
  const Eigen::Vector3d p_WB(4, 5, 6), p_BA(0.3, -0.1, 0.9);
  Bench bench({"gps_pose",
               {{"heading", Text("truth")}, {"antenna_m", std::vector<double>{0.3, -0.1, 0.9}}}});
  bench.write_truth(p_WB, rpy);
  bench.write_fix(p_WB + quaternion_from_rpy(rpy) * p_BA, bench.now);
  bench.tick();
  EXPECT_NEAR((bench.estimate.value().X_WB.p - p_WB).norm(), 0.0, 1e-12);
}

/// The same place by the mounting alone; a given antenna wins.
TEST(GpsPose, KnowsWhereTheReceiverIsMounted) {
  const Eigen::Vector3d p_WB(4, 5, 6), p_BA(0.3, -0.1, 0.9);
  const auto place = [&](Values values) {
    SensorMounting receiver;
    receiver.name = "gps";
    receiver.X_BS.p = p_BA;
    values.emplace_back("heading", Text("truth"));
    Bench bench({"gps_pose", values}, 1, {receiver});
    bench.write_truth(p_WB, {0.1, -0.2, 0.9});
    bench.write_fix(p_WB + quaternion_from_rpy({0.1, -0.2, 0.9}) * p_BA, bench.now);
    bench.tick();
    return bench.estimate.value().X_WB.p;
  };
  EXPECT_NEAR((place({}) - p_WB).norm(), 0.0, 1e-12);
  EXPECT_NEAR((place({{"antenna_m", std::vector<double>{0, 0, 0}}}) - p_WB).norm(), p_BA.norm(),
              1e-12);
}

TEST(GpsPose, CarriesTheFixOnByItsVelocityIfAsked) {
  Bench bench({"gps_pose", {{"heading", Text("truth")}, {"extrapolate", true}}});
  bench.write_truth({0, 0, 0});
  bench.write_fix({1, 0, 0}, bench.now, {2, 0, 0});
  for (int i = 0; i < 5; ++i) bench.tick();
  EXPECT_NEAR(bench.estimate.value().X_WB.p.x(), 1.0 + 4 * 0.025 * 2.0, 1e-12);
}

TEST(HeadingSource, TakesTheTruthOnlyWhereItIsAskedFor) {
  // By default it waits for an IMU, and knows where it was set down to `start_yaw_std_deg`.
  double sum = 0.0, sum_of_squares = 0.0;
  constexpr int kVehicles = 400;
  for (std::uint64_t seed = 1; seed <= kVehicles; ++seed) {
    Bench bench({"gps_pose", {{"start_yaw_std_deg", 2.0}}}, seed);
    bench.write_truth({0, 0, 0}, {0, 0, 1.0});
    bench.write_fix({0, 0, 0}, bench.now);
    bench.tick();
    ASSERT_FALSE(bench.estimate.has_value());
    bench.imu.write(bench.now, ImuSample{});
    bench.tick();
    const double error = deg_from_rad(yaw_from_quaternion(bench.estimate.value().X_WB.q) - 1.0);
    sum += error;
    sum_of_squares += error * error;
  }
  // Four standard errors of 400 draws.
  EXPECT_NEAR(sum / kVehicles, 0.0, 0.4);
  EXPECT_NEAR(std::sqrt(sum_of_squares / kVehicles), 2.0, 0.3);
}

TEST(HeadingSource, SumsUpTheGyroFromTheTrueStart) {
  Bench bench({"gps_pose", {{"heading", Text("gyro")}, {"start_yaw_std_deg", 0.0}}});
  bench.write_truth({0, 0, 0}, {0, 0, 3.0});
  bench.write_fix({0, 0, 0}, bench.now);
  ImuSample sample;
  sample.w_WS_S.z() = 0.4;
  for (int i = 0; i <= 40; ++i) {
    bench.imu.write(bench.now, sample);
    bench.tick();
  }
  EXPECT_NEAR(wrap_angle(yaw_from_quaternion(bench.estimate.value().X_WB.q) - 3.4), 0.0, 1e-9);
}

/// Mounted upside down, a unit measures the yaw rate about its -z; on its side about y.
TEST(HeadingSource, KnowsHowTheInertialUnitIsMounted) {
  const double quarter = 0.5 * kPi;
  for (const RollPitchYaw& rpy : {RollPitchYaw{kPi, 0, 0}, RollPitchYaw{quarter, 0, 0}}) {
    SensorMounting unit;
    unit.name = "imu";
    unit.X_BS.q = quaternion_from_rpy(rpy);
    Bench bench({"gps_pose", {{"heading", Text("gyro")}, {"start_yaw_std_deg", 0.0}}}, 1, {unit});
    bench.write_truth({0, 0, 0});
    bench.write_fix({0, 0, 0}, bench.now);
    ImuSample sample;
    sample.w_WS_S = rpy.roll_rad == kPi ? Eigen::Vector3d(0, 0, -0.4) : Eigen::Vector3d(0, 0.4, 0);
    for (int i = 0; i <= 40; ++i) {
      bench.imu.write(bench.now, sample);
      bench.tick();
    }
    EXPECT_NEAR(yaw_from_quaternion(bench.estimate.value().X_WB.q), 0.4, 1e-9);
    EXPECT_NEAR(bench.estimate.value().w_WB_B.z(), 0.4, 1e-12);
  }
}

TEST(HeadingSource, CourseTakesOutTheGyrosBias) {
  // Straight east at 1 m/s with a bias of 0.01 rad/s: gyro alone is 0.6 rad off after a minute;
  // drawn to the course over 5 s the error settles at bias times that time, 0.05 rad.
  for (const char* heading : {"gyro", "gyro_course"}) {
    Bench bench({"gps_pose", {{"heading", Text(heading)}, {"start_yaw_std_deg", 0.0}}});
    ImuSample sample;
    sample.w_WS_S.z() = 0.01;
    bench.write_truth({0, 0, 0});
    for (int i = 0; i < 2400; ++i) {
      bench.imu.write(bench.now, sample);
      if (i % 8 == 0) bench.write_fix({0.025 * i, 0, 0}, bench.now, {1, 0, 0});
      bench.tick();
    }
    const double error = yaw_from_quaternion(bench.estimate.value().X_WB.q);
    EXPECT_NEAR(error, Text(heading) == "gyro" ? 0.6 : 0.05, 0.003);
  }
}

TEST(OdometryFilter, AFixedGainOfZeroCorrectsNothing) {
  Bench bench({"odometry_filter",
               {{"heading", Text("truth")}, {"gain", Text("fixed")}, {"position_gain", 0.0}}});
  bench.write_truth({0, 0, 0});
  bench.command.write(bench.now, {0.0, 0.0});
  bench.write_fix({0, 0, 0}, bench.now);
  bench.tick();
  bench.write_fix({1, 0, 0}, bench.now);
  bench.tick();
  EXPECT_EQ(bench.estimate.value().X_WB.p.x(), 0.0);
}

TEST(OdometryFilter, DeadReckonsExactlyOverArcs) {
  Bench bench({"odometry_filter", {{"heading", Text("truth")}, {"gain", Text("fixed")}}});
  controllers::Pose2 pose;
  bench.write_truth({0, 0, 0});
  bench.write_fix({0, 0, 0}, bench.now);
  bench.command.write(bench.now, {1.5, 0.6});
  bench.tick();
  for (int i = 0; i < 200; ++i) {
    pose = controllers::advance(pose, 1.5 * 0.025, 0.6 * 0.025);
    bench.write_truth({0, 0, 0}, {0, 0, pose.yaw_rad});
    bench.tick();
  }
  EXPECT_NEAR((bench.estimate.value().X_WB.p.head<2>() - pose.p).norm(), 0.0, 1e-12);
}

TEST(OdometryFilter, ReadsTheWheelsByName) {
  Bench bench(
      {"odometry_filter", {{"heading", Text("truth")}, {"odometry_source", Text("wheels")}}});
  NamedValues wheels;
  wheels.names = {"wheel_fl_slip", "wheel_fl_speed_radps", "wheel_fr_speed_radps",
                  "wheel_rl_speed_radps", "wheel_rr_speed_radps"};
  wheels.values = {99.0, 4.0, 6.0, 4.0, 6.0};
  bench.write_truth({0, 0, 0});
  bench.write_fix({0, 0, 0}, bench.now);
  bench.tick();
  bench.wheels.write(bench.now, wheels);
  for (int i = 0; i < 40; ++i) bench.tick();
  EXPECT_NEAR(bench.estimate.value().X_WB.p.x(), 1.0, 1e-9);  // 5 rad/s * 0.2 m for 1 s
}

TEST(OdometryFilter, SatelliteVelocitySeesTheSlide) {
  // Nose east, drifting north at 0.3 m/s: the wheels know nothing of it.
  Bench bench({"odometry_filter",
               {{"heading", Text("truth")},
                {"odometry_source", Text("gps_velocity")},
                {"gain", Text("fixed")}}});
  bench.write_truth({0, 0, 0});
  bench.write_fix({0, 0, 0}, bench.now, {1.0, 0.3, 0});
  bench.tick();
  for (int i = 0; i < 40; ++i) bench.tick();
  EXPECT_NEAR(bench.estimate.value().X_WB.p.x(), 1.0, 1e-9);
  EXPECT_NEAR(bench.estimate.value().X_WB.p.y(), 0.3, 1e-9);
  EXPECT_NEAR(bench.estimate.value().v_WB_B.y(), 0.3, 1e-12);
}

TEST(OdometryFilter, ComparesALateFixWithThePastItSaw) {
  // 1 m/s east; fixes are exact but 0.2 s old. Taken for new they would hold the estimate 0.2 m
  // back.
  Bench bench({"odometry_filter",
               {{"heading", Text("truth")}, {"gain", Text("fixed")}, {"position_gain", 0.5}}});
  bench.write_truth({0, 0, 0});
  bench.write_fix({0, 0, 0}, bench.now);
  bench.tick();
  bench.command.write(bench.now, {1.0, 0.0});
  for (int i = 1; i < 400; ++i) {
    const double x = 0.025 * i;
    if (i % 8 == 0) bench.write_fix({x - 0.2, 0, 0}, Time{bench.now.ns - 200'000'000});
    bench.tick();
    ASSERT_NEAR(bench.estimate.value().X_WB.p.x(), x, 1e-9);
  }
}

TEST(OdometryFilter, TakesAPoseFromOutside) {
  Bench bench(
      {"odometry_filter", {{"heading", Text("gyro")}, {"initial_pose_from_outside", true}}});
  bench.write_truth({1.0, 2.0, 0.4});
  bench.imu.write(bench.now, {});
  bench.write_fix({1.0, 2.0, 0.4}, bench.now);
  bench.tick();
  Odometry pose;
  pose.X_WB = {quaternion_from_rpy({0, 0, 0.5}), {5.0, -3.0, 77.0}};
  pose.position_variance_m2 = {0.25, 0.09, 0.0};
  bench.give_pose(pose);
  bench.command.write(bench.now, {2.0, 0.0});
  bench.tick();
  const Odometry moved = bench.estimate.value();
  EXPECT_LT((moved.X_WB.p - Eigen::Vector3d(5.0, -3.0, 0.4)).norm(), 1e-12)
      << "a viewer does not know the height";
  EXPECT_NEAR(yaw_from_quaternion(moved.X_WB.q), 0.5, 1e-12);
  EXPECT_NEAR(moved.position_variance_m2.x(), 0.25, 1e-12);
  EXPECT_NEAR(moved.position_variance_m2.y(), 0.09, 1e-12);
  EXPECT_EQ(bench.event_text(),
            "the pose (5.00, -3.00), 28.6 deg from outside replaces the estimate");
  bench.tick();
  const Eigen::Vector3d ahead = 0.05 * Eigen::Vector3d(std::cos(0.5), std::sin(0.5), 0.0);
  EXPECT_LT((bench.estimate.value().X_WB.p - moved.X_WB.p - ahead).norm(), 1e-12) << "taken once";
}

TEST(OdometryFilter, RefusesWheelsWhereThereAreNone) {
  const VehicleDescription description = [] {
    VehicleDescription d;
    d.type = "quadrotor";
    d.wheeled.emplace().wheel_radius_m = 0.2;
    return d;
  }();
  EstimatorContext context;
  context.part = "uav.estimator";
  context.vehicle_description = &description;
  const PartSpec& spec = parts().spec(PartKind::kEstimator, "odometry_filter");
  try {
    parts().make_estimator("odometry_filter",
                           make_parameters(spec, {{"odometry_source", Text("wheels")}}), context);
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "uav.estimator (odometry_filter): odometry_source = wheels, but vehicle type "
                 "'quadrotor' has no wheel speeds");
  }
}

TEST(OdometryKalman, SettlesAtTheRiccatiGain) {
  // Without scale each axis is a scalar random walk: P = P q / ... has the fixed point p with
  // p^2 / (p + r) = q, p before the fix; gain p / (p + r).
  controllers::OdometryKalmanParams params;
  params.scale_std = params.scale_drift_per_sqrt_m = 0.0;
  params.drift_m_per_sqrt_m = 0.01;
  controllers::OdometryKalman filter(params);
  const Eigen::Vector2d std_m(0.05, 0.05), d(0.04, 0.0);
  filter.start({0, 0}, std_m);
  for (int i = 0; i < 2000; ++i) {
    filter.predict(d);
    filter.correct({0, 0}, std_m);
  }
  const double q = 1e-4 * 0.04, r = 0.0025;
  const double p = 0.5 * (q + std::sqrt(q * q + 4.0 * q * r));
  filter.predict(d);
  EXPECT_NEAR(filter.covariance()(0, 0), p, 1e-9 * r);
  const double before = filter.p().x();
  filter.correct({1.0, 0.0}, std_m);
  EXPECT_NEAR(filter.p().x() - before, p / (p + r), 1e-6);
}

TEST(OdometryKalman, LearnsTheScaleAndItsErrorIsWhatItSays) {
  // Wheels measure 3 % too little. Over many runs the error of position and scale, divided by the
  // stated sigma, has about unit variance (200 runs: standard error 10 %).
  double position_chi2 = 0.0, scale_chi2 = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    RandomStream random(run + 1, "test", "kalman");
    controllers::OdometryKalmanParams params;
    params.scale_drift_per_sqrt_m = 0.0;
    params.drift_m_per_sqrt_m = 0.005;
    const double scale = 1.0 + params.scale_std * random.normal();
    const Eigen::Vector2d std_m(0.02, 0.02);
    controllers::OdometryKalman filter(params);
    Eigen::Vector2d p(0, 0);
    filter.start(p + Eigen::Vector2d(0.02 * random.normal(), 0.02 * random.normal()), std_m);
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector2d d = 0.05 * controllers::direction(0.005 * i);
      const double drift = params.drift_m_per_sqrt_m * std::sqrt(0.05);
      p += scale * d + Eigen::Vector2d(drift * random.normal(), drift * random.normal());
      filter.predict(d);
      const Eigen::Vector2d fix =
          p + Eigen::Vector2d(0.02 * random.normal(), 0.02 * random.normal());
      filter.correct(fix - filter.p(), std_m);
    }
    position_chi2 += std::pow((filter.p().x() - p.x()) / filter.std_m().x(), 2) / kRuns;
    scale_chi2 += std::pow(filter.scale() - scale, 2) / filter.covariance()(2, 2) / kRuns;
  }
  EXPECT_NEAR(position_chi2, 1.0, 0.3);
  EXPECT_NEAR(scale_chi2, 1.0, 0.3);
}

}  // namespace
}  // namespace vinerow::test::estimation_test
