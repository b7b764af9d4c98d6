// The estimator error_state_kalman between signals: start, mounting, sources, late and bad data.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/estimation/inertial/navigation_start.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/heading.h"
#include "engine/api/messages/sensors.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/estimation/inertial/imu_course.h"
#include "tests/controllers/support/mission.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::error_state_estimator_test {
namespace {

using Eigen::Vector3d;
using Text = std::string;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t k10ms = 10'000'000;

/// Sensors without noise on a course; the estimator's tick is 10 ms.
class Bench {
 public:
  explicit Bench(ImuCourse its_course, const Values& values = {}, std::uint64_t seed = 1)
      : course(its_course), description_(make_rover_description()) {
    Ports world(bus_, "rover", "test");
    truth = world.write<Odometry>("truth");
    gps = world.write<GnssFix>("gps");
    imu = world.write<ImuSample>("imu");
    baro = world.write<PressureSample>("baro");
    compass = world.write<MagneticSample>("compass");
    wheels = world.write<NamedValues>("wheels");
    antennas = world.write<GnssHeading>("antennas");
    estimate = world.read<Odometry>("estimate");
    state = world.read<NamedValues>("estimator_state");
    event = world.read<Event>("estimator_event");
    EstimatorContext context;
    context.vehicle = "rover";
    context.part = "rover.estimator";
    context.period = Duration{k10ms};
    context.seed = seed;
    context.vehicle_description = &description_;
    context.sensors = {{"imu", "imu", X_BI},
                       {"gps", "gps", X_BA},
                       {"compass", "magnetometer", X_BM},
                       {"antennas", "gnss_heading", X_BH}};
    const PartSpec& spec = parts().spec(PartKind::kEstimator, "error_state_kalman");
    estimator =
        parts().make_estimator("error_state_kalman", make_parameters(spec, values), context);
    Ports ports(bus_, "rover", "rover.estimator");
    estimator->connect(ports);
    for (const ActuatorSpec& actuator : description_.actuators) {
      speeds_.names.push_back(actuator.name);
    }
    speeds_.values.assign(speeds_.names.size(), 0.0);
  }

  Odometry truth_at(double t) const {
    const CoursePoint point = course.at(t);
    Odometry odometry;
    odometry.X_WB = {point.state.q_WB, point.state.p_WI};
    odometry.w_WB_B = point.w_B;
    odometry.v_WB_B = point.state.q_WB.conjugate() * point.state.v_WI;
    return odometry;
  }
  /// What the unit reads at its place: its lever arm's accelerations by differences of the rate.
  ImuSample reading_at(double t) const {
    const CoursePoint point = course.at(t);
    const double h = 1e-5;
    const Vector3d alpha_B = (course.at(t + h).w_B - course.at(t - h).w_B) / (2 * h);
    const Vector3d f_B =
        point.f_B + alpha_B.cross(X_BI.p) + point.w_B.cross(point.w_B.cross(X_BI.p)) + accel_bias_B;
    return {X_BI.q.conjugate() * (point.w_B + gyro_bias_B), X_BI.q.conjugate() * f_B};
  }
  GnssFix fix_at(double t) const {
    const Odometry o = truth_at(t);
    GnssFix fix;
    fix.valid = true;
    fix.p_W = o.X_WB * X_BA.p;
    fix.v_W = o.X_WB.q * (o.v_WB_B + o.w_WB_B.cross(X_BA.p));
    fix.std_m.setConstant(0.05);
    fix.velocity_std_mps = 0.05;
    return fix;
  }
  MagneticSample field_at(double t) const {
    MagneticSample sample;
    // North and down, as in Europe.
    sample.field_S_T =
        X_BM.q.conjugate() * (truth_at(t).X_WB.q.conjugate() * Vector3d(0, 2e-5, -4e-5));
    return sample;
  }

  /// Measurement of two antennas 1.2 m apart, 7 mm on each axis.
  GnssHeading baseline_at(double t) const {
    GnssHeading reading;
    reading.valid = true;
    reading.length_m = 1.2;
    reading.baseline_W = truth_at(t).X_WB.q * (X_BH.q * Vector3d(1.2, 0, 0));
    reading.std_m.setConstant(0.007);
    reading.heading_rad = std::atan2(reading.baseline_W.y(), reading.baseline_W.x());
    reading.heading_std_rad = 0.007 / 1.2;
    return reading;
  }

  /// One tick with everything written that is due.
  void tick() {
    const double t = now().s();
    truth.write(now(), truth_at(t));
    if (imu_on) imu.write(now(), reading_at(t));
    if (gps_on && ticks % 20 == 0 && ticks >= late_ticks) {
      const Time measured = tick_at(ticks - late_ticks, k10ms);
      gps.write(measured, fix_at(measured.s()));
    }
    compass.write(now(), field_at(t));
    if (ticks % 20 == 0 && ticks >= late_ticks) {
      const Time measured = tick_at(ticks - late_ticks, k10ms);
      antennas.write(measured, baseline_at(measured.s()));
    }
    estimator->step(now());
    ++ticks;
  }
  void run(double seconds) {
    for (const std::int64_t end = ticks + std::llround(seconds * 100); ticks < end;) tick();
  }
  Time now() const { return tick_at(ticks, k10ms); }
  double error_m() const {
    return (estimate.value().X_WB.p - truth_at(estimate.stamp().s()).X_WB.p).norm();
  }
  double yaw_error_rad() const {
    return wrap_angle(yaw_from_quaternion(estimate.value().X_WB.q) -
                      yaw_from_quaternion(truth_at(estimate.stamp().s()).X_WB.q));
  }
  double value(const std::string& name) const {
    const NamedValues& values = state.value();
    const auto at = std::find(values.names.begin(), values.names.end(), name);
    if (at == values.names.end()) ADD_FAILURE() << "no value " << name;
    return at == values.names.end() ? kNaN : values.values[at - values.names.begin()];
  }
  /// As a program outside the run.
  void give_pose(const Odometry& pose) {
    static_cast<Signal<Odometry>*>(bus_.find("rover/initialpose"))->write(now(), pose);
  }
  void write_wheels(double rim_mps) {
    speeds_.values.assign(speeds_.names.size(), rim_mps / description_.wheeled->wheel_radius_m);
    wheels.write(now(), speeds_);
  }

  ImuCourse course;
  Pose X_BI{quaternion_from_rpy({0.1, -0.2, 0.5}), {0.15, -0.1, 0.05}};
  Pose X_BA{Eigen::Quaterniond::Identity(), {-0.3, 0.2, 0.6}};
  Pose X_BM{quaternion_from_rpy({3.0, 0.1, -0.4}), {0, 0, 0.2}};
  Pose X_BH{quaternion_from_rpy({0.0, 0.0, 1.3}), {-0.3, 0.2, 0.6}};
  Vector3d gyro_bias_B = Vector3d::Zero(), accel_bias_B = Vector3d::Zero();
  bool imu_on = true, gps_on = true;
  int late_ticks = 0;
  std::int64_t ticks = 0;
  SignalWriter<Odometry> truth;
  SignalWriter<GnssFix> gps;
  SignalWriter<ImuSample> imu;
  SignalWriter<PressureSample> baro;
  SignalWriter<MagneticSample> compass;
  SignalWriter<NamedValues> wheels;
  SignalWriter<GnssHeading> antennas;
  SignalReader<Odometry> estimate;
  SignalReader<NamedValues> state;
  SignalReader<Event> event;
  std::unique_ptr<Estimator> estimator;

 private:
  VehicleDescription description_;
  SignalBus bus_;
  NamedValues speeds_;
};

ImuCourse at_rest() {
  return {};
}
/// Straight on along x with 1 m/s, as far as a swing of an hour is straight.
ImuCourse straight() {
  ImuCourse course;
  course.x = {1e4, 1e-4, 0};
  return course;
}

TEST(ErrorStateEstimator, FollowsALivelyCourseWithTiltedUnitAndAntennaOffIt) {
  Bench bench(lively_course());
  bench.gyro_bias_B = {0.002, -0.001, 0.003};
  bench.accel_bias_B = {0.03, -0.02, 0.04};
  bench.run(60.0);
  EXPECT_LT(bench.error_m(), 0.02);
  EXPECT_LT(std::abs(bench.yaw_error_rad()), 0.005);
  const Odometry truth = bench.truth_at(bench.estimate.stamp().s());
  EXPECT_LT((bench.estimate.value().v_WB_B - truth.v_WB_B).norm(), 0.02);
  EXPECT_LT((bench.estimate.value().w_WB_B - truth.w_WB_B).norm(), 0.001);
  EXPECT_EQ(bench.value("used_gnss_position"), 300);
  EXPECT_EQ(bench.value("used_gnss_velocity"), 300);
  EXPECT_EQ(bench.value("rejected_gnss_position"), 0);
  EXPECT_EQ(bench.value("imu_refused"), 0);
  EXPECT_EQ(bench.value("covariance_repairs"), 0);
  EXPECT_GT(bench.estimate.value().yaw_std_rad, 0.0);
  EXPECT_GT(bench.estimate.value().position_covariance().llt().matrixL().determinant(), 0.0);
}

TEST(ErrorStateEstimator, TakesFixesAsOldAsTheirStampSays) {
  Bench bench(lively_course());
  bench.late_ticks = 20;
  bench.run(60.0);
  EXPECT_LT(bench.error_m(), 0.03);
  EXPECT_EQ(bench.value("rejected_gnss_position"), 0);
}

TEST(ErrorStateEstimator, TakesAPoseFromOutside) {
  Bench bench(straight(), {{"initial_pose_from_outside", true}});
  bench.run(5.0);
  bench.gps_on = false;
  const double z_m = bench.estimate.value().X_WB.p.z();
  Odometry pose;
  pose.X_WB = {quaternion_from_rpy({0, 0, 0.4}), {5.0, -3.0, 77.0}};
  pose.position_variance_m2 = {0.25, 0.09, 0.0};
  pose.yaw_std_rad = 0.1;
  bench.give_pose(pose);
  bench.tick();
  const Odometry moved = bench.estimate.value();
  EXPECT_LT((moved.X_WB.p.head<2>() - Eigen::Vector2d(5, -3)).norm(), 1e-9);
  EXPECT_NEAR(moved.X_WB.p.z(), z_m, 1e-3) << "a viewer does not know the height";
  EXPECT_NEAR(yaw_from_quaternion(moved.X_WB.q), 0.4, 1e-9);
  EXPECT_NEAR(moved.v_WB_B.x(), 1.0, 0.02) << "it goes on in its own direction";
  // The unit's lever arm adds the little that the heading's error moves the body.
  EXPECT_NEAR(moved.position_variance_m2.x(), 0.25, 1e-3);
  EXPECT_NEAR(moved.position_variance_m2.y(), 0.09, 1e-3);
  EXPECT_NEAR(moved.yaw_std_rad, 0.1, 1e-9);
  bench.run(1.0);
  const Eigen::Vector2d ahead(std::cos(0.4), std::sin(0.4));
  EXPECT_LT((bench.estimate.value().X_WB.p.head<2>() - Eigen::Vector2d(5, -3) - ahead).norm(),
            0.05);
  EXPECT_EQ(bench.event.value().text,
            "the pose (5.00, -3.00), 22.9 deg from outside replaces the estimate");
}

TEST(ErrorStateEstimator, StartsAboutTheTruthByItsStatedSpread) {
  const int seeds = 200;
  double squares = 0.0, yaw_squares = 0.0;
  for (int seed = 0; seed < seeds; ++seed) {
    Bench bench(at_rest(),
                {{"start_std_m", 0.4}, {"start_height_std_m", 0.1}, {"start_yaw_std_deg", 5.0}},
                seed);
    bench.gps_on = false;
    bench.tick();
    const Vector3d p = bench.estimate.value().X_WB.p;
    squares += (p.head<2>().squaredNorm() / 0.16 + p.z() * p.z() / 0.01) / 3.0;
    yaw_squares += std::pow(bench.yaw_error_rad(), 2);
    EXPECT_NEAR(bench.estimate.value().position_variance_m2.x(), 0.16, 0.001);
    EXPECT_NEAR(bench.estimate.value().position_variance_m2.z(), 0.01, 0.001);
  }
  // Chi-square of 600 and 200 degrees within four sigmas.
  EXPECT_NEAR(squares / seeds, 1.0, 4 * std::sqrt(2.0 / (3 * seeds)));
  EXPECT_NEAR(yaw_squares / seeds / std::pow(rad_from_deg(5), 2), 1.0, 4 * std::sqrt(2.0 / seeds));
}

TEST(ErrorStateEstimator, LevelsItselfAndReadsTheCompass) {
  ImuCourse tilted = at_rest();
  tilted.roll = {0.2, 0, 0.5 * kPi};
  tilted.pitch = {-0.15, 0, 0.5 * kPi};
  tilted.yaw = {2.0, 0, 0.5 * kPi};
  Bench bench(tilted, {{"start", Text("levelling")}, {"magnetometer", Text("compass")}});
  bench.run(0.9);
  EXPECT_FALSE(bench.estimate.has_value());
  bench.run(2.0);
  ASSERT_TRUE(bench.estimate.has_value());
  EXPECT_LT(bench.estimate.value().X_WB.q.angularDistance(bench.truth_at(0).X_WB.q), 1e-3);
  EXPECT_LT(bench.error_m(), 0.01);
  EXPECT_GT(bench.value("used_magnetometer"), 100);
  EXPECT_EQ(bench.value("rejected_gnss_position"), 0);
}

TEST(ErrorStateEstimator, KeepsItsHeadingAtRestByTheCompass) {
  for (const bool has_compass : {false, true}) {
    Bench bench(at_rest(), {{"magnetometer", Text(has_compass ? "compass" : "")}});
    bench.gyro_bias_B = {0, 0, 3e-4};
    bench.run(120.0);
    if (has_compass) {
      EXPECT_LT(std::abs(bench.yaw_error_rad()), 0.015);
      EXPECT_LT(bench.estimate.value().yaw_std_rad, 0.015);
    } else {
      EXPECT_GT(bench.estimate.value().yaw_std_rad, 0.04);
    }
  }
}

TEST(ErrorStateEstimator, HoldsItsHeightByTheBarometer) {
  Bench bench(straight(), {{"barometer", Text("baro")}, {"barometer_std_m", 0.1}});
  bench.accel_bias_B = {0, 0, 0.02};
  const auto write_pressure = [&] {
    // 288.15 K and 1013.25 hPa at height zero: 11.98 Pa/m.
    PressureSample sample;
    sample.pressure_Pa = 101'325.0 - 11.98 * bench.truth_at(bench.now().s()).X_WB.p.z();
    bench.baro.write(bench.now(), sample);
  };
  for (int i = 0; i < 6000; ++i) {
    write_pressure();
    bench.tick();
  }
  bench.gps_on = false;
  for (int i = 0; i < 6000; ++i) {
    write_pressure();
    bench.tick();
  }
  EXPECT_LT(std::abs(bench.estimate.value().X_WB.p.z()), 0.3);
  EXPECT_LT(std::sqrt(bench.estimate.value().position_variance_m2.z()), 1.0);
  PressureSample broken;
  broken.pressure_Pa = kNaN;
  const double before = bench.value("rejected_barometer");
  bench.baro.write(bench.now(), broken);
  bench.tick();
  EXPECT_EQ(bench.value("rejected_barometer"), before + 1);
}

TEST(NavigationStart, KnowsTheStandardAtmosphere) {
  // US Standard Atmosphere 1976, table: 1000 m 89 874.6 Pa, 5000 m 54 019.9 Pa (geopotential).
  EXPECT_NEAR(controllers::standard_height_m(101'325.0), 0.0, 1e-9);
  EXPECT_NEAR(controllers::standard_height_m(89'874.6), 1000.0, 0.1);
  EXPECT_NEAR(controllers::standard_height_m(54'019.9), 5000.0, 0.1);
}

TEST(ErrorStateEstimator, WheelsHoldARoverThroughAnOutage) {
  double errors[2];
  for (const bool has_wheels : {false, true}) {
    Bench bench(straight(),
                {{"wheels", Text(has_wheels ? "wheels" : "")}, {"start_yaw_std_deg", 0.5}});
    bench.accel_bias_B = {0.02, -0.02, 0.01};
    bench.gyro_bias_B = {1e-4, 1e-4, 1e-4};
    const auto run = [&](int ticks) {
      for (int i = 0; i < ticks; ++i) {
        bench.write_wheels(1.0);
        bench.tick();
      }
    };
    run(200);  // too short to find the biases
    bench.gps_on = false;
    run(3000);
    errors[has_wheels] = bench.error_m();
    EXPECT_EQ(bench.value("used_wheels") > 3000, has_wheels);
  }
  EXPECT_LT(errors[1], 1.0);
  EXPECT_GT(errors[0], 3.0 * errors[1]);
}

TEST(ErrorStateEstimator, KnowsThatItStands) {
  for (const char* how : {"imu", "wheels"}) {
    Bench bench(at_rest(), {{"zero_velocity", Text(how)}, {"wheels", Text("wheels")}});
    bench.gps_on = false;
    bench.gyro_bias_B = {0, 0, 2e-4};
    for (int i = 0; i < 6000; ++i) {
      bench.write_wheels(0.0);
      bench.tick();
    }
    EXPECT_GT(bench.value("used_zero_velocity"), 280) << how;
    EXPECT_LT(bench.estimate.value().v_WB_B.norm(), 0.01) << how;
    EXPECT_NEAR(bench.estimate.value().w_WB_B.z(), 0.0, 2e-5) << how;
  }
}

TEST(ErrorStateEstimator, IsNotFooledByBadData) {
  Bench bench(lively_course());
  bench.run(20.0);
  bench.tick();  // with a good fix, the last for 0.2 s
  GnssFix bad = bench.fix_at(20.0);
  bad.p_W.y() = kNaN;
  bench.gps.write(bench.now(), bad);
  bench.tick();
  EXPECT_EQ(bench.value("rejected_gnss_position"), 1);

  bad = bench.fix_at(20.0);
  bad.p_W.x() += 50.0;  // far off
  bench.gps.write(bench.now(), bad);
  bench.tick();
  bench.gps.write(tick_at(1000, k10ms), bench.fix_at(10.0));  // backwards
  bench.tick();
  bad.valid = false;  // says itself that it is none
  bench.gps.write(bench.now(), bad);
  bench.tick();
  EXPECT_EQ(bench.value("rejected_gnss_position"), 3);
  ImuSample broken = bench.reading_at(bench.now().s());
  broken.w_WS_S.x() = kNaN;
  bench.imu.write(bench.now(), broken);
  bench.imu_on = false;
  bench.tick();
  bench.imu_on = true;
  EXPECT_EQ(bench.value("imu_refused"), 1);
  bench.run(5.0);
  EXPECT_LT(bench.error_m(), 0.05);
  EXPECT_EQ(bench.value("rejected_gnss_position"), 3);
  EXPECT_EQ(bench.value("restarts"), 0);
}

TEST(ErrorStateEstimator, GoesStraightOnWithoutReadingsAndComesBack) {
  Bench bench(straight());
  bench.run(20.0);
  bench.imu_on = false;
  bench.run(5.0);
  EXPECT_LT(bench.error_m(), 0.5);
  EXPECT_EQ(bench.estimate.stamp(), tick_at(bench.ticks - 1, k10ms));
  EXPECT_EQ(bench.value("imu_gaps"), 1);
  bench.imu_on = true;
  bench.run(20.0);
  EXPECT_LT(bench.error_m(), 0.03);
  EXPECT_EQ(bench.value("rejected_gnss_position"), 0);
}

TEST(ErrorStateEstimator, BeginsAnewWhereAllFixesContradictIt) {
  Bench bench(lively_course());
  bench.run(20.0);
  // Fixes jump by 30 m. To the filter this is the same as a receiver whose earlier fixes were all
  // wrong.
  const auto shifted = [&](double seconds) {
    for (const std::int64_t end = bench.ticks + std::llround(seconds * 100); bench.ticks < end;) {
      if (bench.ticks % 20 == 0) {
        GnssFix fix = bench.fix_at(bench.now().s());
        fix.p_W += Vector3d(30, 0, 0);
        bench.gps.write(bench.now(), fix);
      }
      bench.tick();
    }
  };
  bench.gps_on = false;
  shifted(3.0);
  EXPECT_EQ(bench.value("restarts"), 0);
  EXPECT_LT(bench.error_m(), 0.3);
  shifted(10.0);
  EXPECT_EQ(bench.value("restarts"), 1);
  const Vector3d off =
      bench.estimate.value().X_WB.p - bench.truth_at(bench.estimate.stamp().s()).X_WB.p;
  EXPECT_LT((off - Vector3d(30, 0, 0)).norm(), 0.1);
}

TEST(ErrorStateEstimator, SaysTheSameAtHalfTheRateOfTheUnit) {
  Bench bench(lively_course());
  // The estimator sees every second reading only.
  bench.truth.write(Time{}, bench.truth_at(0));
  for (std::int64_t i = 0; i <= 12'000; ++i) {
    const Time now = tick_at(i, k10ms / 2);
    bench.imu.write(now, bench.reading_at(now.s()));
    if (i % 40 == 0) bench.gps.write(now, bench.fix_at(now.s()));
    if (i % 2 == 0) bench.estimator->step(now);
  }
  EXPECT_LT(bench.error_m(), 0.02);
  EXPECT_EQ(bench.value("imu_gaps"), 0);
}

TEST(ErrorStateEstimator, AllocatesNothingAfterTheFirstTick) {
  Bench bench(lively_course(), {{"barometer", Text("baro")},
                                {"magnetometer", Text("compass")},
                                {"wheels", Text("wheels")},
                                {"zero_velocity", Text("imu")}});
  bench.write_wheels(0.0);
  bench.tick();
  std::size_t allocations = 0;
  {
    AllocationCounter counter;
    for (int i = 0; i < 500; ++i) {
      bench.write_wheels(0.5);
      PressureSample sample;
      sample.pressure_Pa = 101'000.0;
      bench.baro.write(bench.now(), sample);
      bench.tick();
    }
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
}

TEST(ErrorStateEstimator, TwoAntennasTellTheHeadingOfAVehicleThatStands) {
  for (const bool has_antennas : {false, true}) {
    SCOPED_TRACE(has_antennas);
    double worst_rad = 0.0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Bench bench(at_rest(),
                  {{"start_yaw_std_deg", 20.0}, {"heading", Text(has_antennas ? "antennas" : "")}},
                  seed);
      bench.late_ticks = 10;
      bench.run(10.0);
      worst_rad = std::max(worst_rad, std::abs(bench.yaw_error_rad()));
      if (has_antennas) {
        // 50 exact readings of 7 mm over 1.2 m: 0.33 deg / sqrt(50).
        EXPECT_LT(bench.estimate.value().yaw_std_rad, rad_from_deg(0.1));
        EXPECT_GT(bench.value("used_heading"), 45);
      }
    }
    if (has_antennas) {
      EXPECT_LT(worst_rad, rad_from_deg(0.1));
    } else {
      EXPECT_GT(worst_rad, rad_from_deg(10.0));
    }
  }
}

TEST(ErrorStateEstimator, LevelsWithTheHeadingOfTwoAntennas) {
  ImuCourse course;
  course.yaw = {2.2, 1e-9, 0.5 * kPi};  // stands turned by 2.2 rad
  Bench bench(course, {{"start", Text("levelling")}, {"heading", Text("antennas")}});
  bench.run(3.0);
  ASSERT_TRUE(bench.estimate.has_value());
  EXPECT_LT(std::abs(bench.yaw_error_rad()), 1e-3);
  EXPECT_GT(std::abs(yaw_from_quaternion(bench.estimate.value().X_WB.q)), 2.0);
}

TEST(ErrorStateEstimator, RefusesStandingByWheelsItDoesNotRead) {
  try {
    Bench bench(at_rest(), {{"zero_velocity", Text("wheels")}});
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    EXPECT_EQ(
        Text(error.what()),
        "rover.estimator (error_state_kalman): zero_velocity = wheels, but no signal is named "
        "in 'wheels'");
  }
}

}  // namespace
}  // namespace vinerow::test::error_state_estimator_test
