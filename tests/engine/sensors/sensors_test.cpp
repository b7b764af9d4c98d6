#include <gtest/gtest.h>

#include <cmath>

#include "engine/api/messages/sensors.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/engine/sensors/sensor_bench.h"
#include "tests/engine/sensors/sensor_parts.h"

namespace vinerow::sensors::sensors_test {
namespace {

using test::SensorBench;

std::unique_ptr<Sensor> make(SensorBench& bench, const std::string& type, double rate_Hz,
                             const test::SensorValues& values, std::uint64_t seed = 1) {
  auto sensor = test::sensor_registry().make_sensor(type, test::sensor_parameters(type, values),
                                                    bench.context(rate_Hz, seed));
  bench.connect(*sensor);
  return sensor;
}

TEST(Gps, IdealFixIsTheAntennaWithItsLeverArm) {
  SensorBench bench;
  auto gps =
      make(bench, "gps", 5.0,
           {{"error", std::string("ideal")}, {"position_m", std::vector<double>{1.0, 0.0, 0.5}}});
  Odometry truth;
  truth.X_WB = {quaternion_from_rpy({0, 0, kPi / 2}), {10, 20, 1}};
  truth.v_WB_B = {2, 0, 0};
  truth.w_WB_B = {0, 0, 0.5};
  bench.truth.write(Time{0}, truth);
  gps->step(Time{0});
  const GnssFix& fix = bench.bus.subscribe<GnssFix>("rover/s", "test").value();
  // By hand: the antenna is 1 m ahead, which is north; its velocity adds w x r = 0.5 m/s to the
  // left (west).
  EXPECT_NEAR((fix.p_W - Eigen::Vector3d(10, 21, 1.5)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((fix.v_W - Eigen::Vector3d(-0.5, 2, 0)).norm(), 0.0, 1e-12);
  EXPECT_TRUE(fix.valid);
}

TEST(Gps, UniformErrorFillsItsSquareAndNoMore) {
  SensorBench bench;
  auto gps = make(bench, "gps", 40.0, {{"error", std::string("uniform")}, {"accuracy_m", 0.05}});
  bench.truth.write(Time{0}, Odometry{});
  const auto fix = bench.bus.subscribe<GnssFix>("rover/s", "test");
  constexpr int kCount = 20'000;
  double sum_squares = 0.0, largest = 0.0, cross = 0.0;
  for (int i = 0; i < kCount; ++i) {
    gps->step(Time{i * 25'000'000LL});
    const Eigen::Vector3d& p = fix.value().p_W;
    ASSERT_LE(std::abs(p.x()), 0.05);
    ASSERT_LE(std::abs(p.y()), 0.05);
    ASSERT_EQ(p.z(), 0.0);
    largest = std::max(largest, std::abs(p.x()));
    sum_squares += p.x() * p.x();
    cross += p.x() * p.y();
  }
  EXPECT_GT(largest, 0.0499);
  // Variance a^2/3; five standard errors of the mean square (variance of x^2 is 4 a^4/45).
  EXPECT_NEAR(sum_squares / kCount, 0.0025 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / kCount) * 0.0025);
  EXPECT_NEAR(cross / kCount, 0.0, 5.0 * (0.0025 / 3.0) / std::sqrt(kCount));
}

TEST(Gps, OutageGivesInvalidFixesAndDoesNotShiftTheNoise) {
  SensorBench a, b;
  auto plain = make(a, "gps", 5.0, {});
  auto broken = test::sensor_registry().make_sensor(
      "gps", test::with_outage(test::sensor_parameters("gps"), 1.0, 2.0), b.context(5.0));
  b.connect(*broken);
  a.truth.write(Time{0}, Odometry{}), b.truth.write(Time{0}, Odometry{});
  const auto fix_a = a.bus.subscribe<GnssFix>("rover/s", "test"),
             fix_b = b.bus.subscribe<GnssFix>("rover/s", "test");
  for (int i = 0; i < 20; ++i) {
    const Time now{i * 200'000'000LL};
    plain->step(now), broken->step(now);
    const bool out = i >= 5 && i < 10;
    EXPECT_EQ(fix_b.value().valid, !out) << i;
    if (!out) {
      EXPECT_EQ(fix_a.value().p_W, fix_b.value().p_W) << i;
    }
  }
}

TEST(Gps, DelayedFixesKeepTheirTimeOfMeasurement) {
  SensorBench bench;
  auto gps = make(bench, "gps", 5.0, {{"delay_s", 0.5}, {"error", std::string("ideal")}});
  EXPECT_EQ(gps->delay().ns, 500'000'000);
  const auto fix = bench.bus.subscribe<GnssFix>("rover/s", "test");
  Odometry truth;
  for (int i = 0; i < 4; ++i) {
    truth.X_WB.p.x() = i;
    bench.truth.write(Time{i * 200'000'000LL}, truth);
    gps->step(Time{i * 200'000'000LL});
  }
  EXPECT_FALSE(fix.has_value());
  gps->deliver(Time{500'000'000});
  EXPECT_EQ(fix.stamp().ns, 0);
  gps->deliver(Time{700'000'000});
  EXPECT_EQ(fix.stamp().ns, 200'000'000);
  EXPECT_EQ(fix.value().p_W.x(), 1.0);
}

TEST(Gps, GaussMarkovPartHasItsVarianceAndCorrelation) {
  SensorBench bench;
  auto gps = make(bench, "gps", 5.0,
                  {{"horizontal_std_m", 0.0},
                   {"vertical_std_m", 0.0},
                   {"walk_std_m", 0.5},
                   {"walk_time_s", 2.0}});
  bench.truth.write(Time{0}, Odometry{});
  const auto fix = bench.bus.subscribe<GnssFix>("rover/s", "test");
  constexpr int kCount = 100'000;
  double sum_squares = 0.0, lagged = 0.0, last = 0.0;
  for (int i = 0; i < kCount; ++i) {
    gps->step(Time{i * 25'000'000LL});
    const double x = fix.value().p_W.x();
    sum_squares += x * x;
    if (i > 0) lagged += x * last;
    last = x;
  }
  // Closed form: variance 0.25, correlation after one sample exp(-0.2/2). About 10^4 independent
  // samples: 5 %.
  EXPECT_NEAR(sum_squares / kCount, 0.25, 0.0125);
  EXPECT_NEAR(lagged / sum_squares, std::exp(-0.1), 0.01);
}

TEST(Imu, AtRestItReadsGravityAndItsNoiseHasTheStatedDensity) {
  SensorBench bench;
  auto imu =
      make(bench, "imu", 100.0, {{"gyro_noise_dps_rtHz", 0.01}, {"accel_noise_mps2_rtHz", 0.002}});
  bench.truth.write(Time{0}, Odometry{});
  const auto sample = bench.bus.subscribe<ImuSample>("rover/s", "test");
  constexpr int kCount = 20'000;
  double mean_z = 0.0, gyro_squares = 0.0, accel_squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    imu->step(Time{i * 10'000'000LL});
    mean_z += sample.value().f_WS_S.z() / kCount;
    gyro_squares += std::pow(sample.value().w_WS_S.x(), 2) / kCount;
    accel_squares += std::pow(sample.value().f_WS_S.x(), 2) / kCount;
  }
  // density / sqrt(0.01 s) = 10 x density per sample; five standard errors.
  EXPECT_NEAR(mean_z, 9.80665, 5.0 * 0.02 / std::sqrt(kCount));
  EXPECT_NEAR(std::sqrt(gyro_squares), rad_from_deg(0.1),
              rad_from_deg(0.1) * 5.0 / std::sqrt(2.0 * kCount));
  EXPECT_NEAR(std::sqrt(accel_squares), 0.02, 0.02 * 5.0 / std::sqrt(2.0 * kCount));
}

TEST(Imu, TurningAddsTheCentripetalForceOfTheLeverArm) {
  SensorBench bench;
  auto imu = make(bench, "imu", 100.0,
                  {{"gyro_noise_dps_rtHz", 0.0},
                   {"accel_noise_mps2_rtHz", 0.0},
                   {"position_m", std::vector<double>{0.5, 0.0, 0.0}}});
  Odometry truth;
  truth.w_WB_B = {0, 0, 2.0};
  const auto sample = bench.bus.subscribe<ImuSample>("rover/s", "test");
  for (int i = 0; i < 2; ++i) {
    truth.X_WB.q = quaternion_from_rpy({0, 0, 0.02 * i});
    bench.truth.write(Time{i * 10'000'000LL}, truth);
    imu->step(Time{i * 10'000'000LL});
  }
  // Closed form: -w^2 r towards the centre; as a mean over T, 2 w r sin(w T / 2) / T.
  EXPECT_NEAR(sample.value().f_WS_S.x(), -2.0 * std::sin(0.01) / 0.01, 1e-12);
  EXPECT_NEAR(sample.value().w_WS_S.z(), 2.0, 1e-12);
}

TEST(Imu, ReadingsSaturate) {
  SensorBench bench;
  auto imu = make(bench, "imu", 100.0, {{"gyro_range_dps", 100.0}, {"accel_range_mps2", 5.0}});
  Odometry truth;
  truth.w_WB_B = {0, 0, 50.0};
  bench.truth.write(Time{0}, truth);
  imu->step(Time{0});
  const ImuSample& sample = bench.bus.subscribe<ImuSample>("rover/s", "test").value();
  EXPECT_DOUBLE_EQ(sample.w_WS_S.z(), rad_from_deg(100.0));
  EXPECT_DOUBLE_EQ(sample.f_WS_S.z(), 5.0);
}

TEST(Ultrasound, ReadsTheFirstReturnInItsCone) {
  SensorBench bench;
  bench.scene.add_wall(2.0);
  auto single = make(bench, "ultrasound", 20.0, {{"half_angle_deg", 0.0}, {"noise_std_m", 0.0}});
  Odometry truth;
  truth.X_WB.p = {0, 0, 1.0};
  bench.truth.write(Time{0}, truth);
  single->step(Time{0});
  EXPECT_DOUBLE_EQ(bench.bus.subscribe<RangeSample>("rover/s", "test").value().range_m, 2.0);

  // Pitched 30 deg down, the lowest ray of a 15 deg cone meets the ground first: 1 / sin 45 deg.
  SensorBench tilted;
  auto cone = make(tilted, "ultrasound", 20.0,
                   {{"noise_std_m", 0.0}, {"rotation_deg", std::vector<double>{0, 30, 0}}});
  tilted.truth.write(Time{0}, truth);
  cone->step(Time{0});
  EXPECT_NEAR(tilted.bus.subscribe<RangeSample>("rover/s", "test").value().range_m, std::sqrt(2.0),
              1e-12);
}

TEST(Ultrasound, NothingInRangeReadsInfinity) {
  SensorBench bench;
  auto sonar = make(bench, "ultrasound", 20.0, {{"max_range_m", 1.5}, {"noise_std_m", 0.0}});
  Odometry truth;
  truth.X_WB.p = {0, 0, 50.0};
  bench.truth.write(Time{0}, truth);
  sonar->step(Time{0});
  EXPECT_TRUE(std::isinf(bench.bus.subscribe<RangeSample>("rover/s", "test").value().range_m));
}

}  // namespace
}  // namespace vinerow::sensors::sensors_test
