#include <gtest/gtest.h>

#include <cmath>

#include "engine/api/messages/sensors.h"
#include "engine/sensors/air_data.h"
#include "tests/engine/sensors/sensor_bench.h"
#include "tests/engine/sensors/sensor_parts.h"

namespace vinerow::sensors::air_data_test {
namespace {

using Eigen::Vector3d;

class AirDataBench : public ::testing::Test {
 protected:
  void start(const test::SensorValues& values) {
    sensor_ = make_air_data(test::sensor_parameters("air_data", values), bench_.context(20.0));
    bench_.connect(*sensor_);
  }
  Vector3d read(std::int64_t tick) {
    sensor_->step(Time{tick * 50'000'000LL});
    return bench_.bus.subscribe<AirData>("rover/s", "test").value().v_air_B;
  }

  test::SensorBench bench_;
  std::unique_ptr<Sensor> sensor_;
};

TEST_F(AirDataBench, WithoutErrorsItReadsTheVelocityThroughTheAir) {
  start({{"noise_std_mps", 0.0}, {"lag_s", 0.0}});
  bench_.vehicle.air_velocity = {12.0, 1.0, -1.5};
  EXPECT_EQ(read(0), Vector3d(12.0, 1.0, -1.5));
  bench_.vehicle.air_velocity = {13.0, 0.0, -1.0};
  EXPECT_EQ(read(1), Vector3d(13.0, 0.0, -1.0));
}

TEST_F(AirDataBench, AStepIsFollowedWithTheLagOfFirstOrder) {
  start({{"noise_std_mps", 0.0}, {"lag_s", 0.2}});
  bench_.vehicle.air_velocity = {10.0, 0.0, 0.0};
  EXPECT_EQ(read(0).x(), 10.0) << "it does not start from standing";
  bench_.vehicle.air_velocity = {14.0, 0.0, 0.0};
  for (int tick = 1; tick <= 8; ++tick) {
    // Closed form: what is missing dies out as exp(-t / lag).
    EXPECT_NEAR(read(tick).x(), 14.0 - 4.0 * std::exp(-0.05 * tick / 0.2), 1e-12) << tick;
  }
}

TEST_F(AirDataBench, TheScaleErrorIsAShareOfTheReading) {
  start({{"noise_std_mps", 0.0}, {"lag_s", 0.0}, {"scale_error", 0.03}});
  bench_.vehicle.air_velocity = {12.0, -1.0, 0.5};
  EXPECT_NEAR((read(0) - Vector3d(12.36, -1.03, 0.515)).norm(), 0.0, 1e-12);
}

TEST_F(AirDataBench, TooSlowReadsZero) {
  start({{"noise_std_mps", 0.0}, {"lag_s", 0.0}, {"min_airspeed_mps", 3.0}});
  bench_.vehicle.air_velocity = {2.9, 0.0, 0.0};
  EXPECT_EQ(read(0), Vector3d::Zero());
  bench_.vehicle.air_velocity = {2.0, 0.0, -2.3};
  EXPECT_EQ(read(1), Vector3d(2.0, 0.0, -2.3)) << "3.05 m/s from ahead and below";
}

TEST_F(AirDataBench, TheNoiseHasItsSizeOnEveryAxis) {
  start({{"noise_std_mps", 0.4}, {"lag_s", 0.0}});
  constexpr int kCount = 20'000;
  Vector3d sum = Vector3d::Zero(), squares = Vector3d::Zero();
  for (int i = 0; i < kCount; ++i) {
    const Vector3d error = read(i) - bench_.vehicle.air_velocity;
    sum += error;
    squares += error.cwiseAbs2();
  }
  // Five standard errors of mean and mean square.
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sum[axis] / kCount, 0.0, 5.0 * 0.4 / std::sqrt(kCount)) << axis;
    EXPECT_NEAR(squares[axis] / kCount, 0.16, 5.0 * 0.16 * std::sqrt(2.0 / kCount)) << axis;
  }
}

TEST_F(AirDataBench, AnOutageReadsZeroAndDoesNotShiftTheNoise) {
  start({});
  test::SensorBench other;
  auto broken = make_air_data(test::with_outage(test::sensor_parameters("air_data"), 0.25, 0.5),
                              other.context(20.0));
  other.connect(*broken);
  const auto reading = other.bus.subscribe<AirData>("rover/s", "test");
  for (int i = 0; i < 20; ++i) {
    broken->step(Time{i * 50'000'000LL});
    const Vector3d plain_B = read(i);
    const bool out = i >= 5 && i < 10;
    EXPECT_EQ(reading.value().v_air_B, out ? Vector3d(Vector3d::Zero()) : plain_B) << i;
  }
}

TEST_F(AirDataBench, ADelayedReadingKeepsItsTime) {
  start({{"delay_s", 0.1}, {"noise_std_mps", 0.0}, {"lag_s", 0.0}});
  EXPECT_EQ(sensor_->delay().ns, 100'000'000);
  const auto reading = bench_.bus.subscribe<AirData>("rover/s", "test");
  for (int i = 0; i < 3; ++i) {
    bench_.vehicle.air_velocity = {10.0 + i, 0.0, 0.0};
    sensor_->step(Time{i * 50'000'000LL});
  }
  EXPECT_FALSE(reading.has_value());
  sensor_->deliver(Time{100'000'000});
  sensor_->deliver(Time{150'000'000});
  EXPECT_EQ(reading.stamp().ns, 50'000'000);
  EXPECT_EQ(reading.value().v_air_B.x(), 11.0);
}

}  // namespace
}  // namespace vinerow::sensors::air_data_test
