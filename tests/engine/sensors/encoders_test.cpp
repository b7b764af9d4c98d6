#include "engine/sensors/encoders.h"
#include "engine/api/messages/commands.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "tests/engine/sensors/sensor_bench.h"
#include "tests/engine/sensors/sensor_parts.h"
#include "tests/support/no_alloc.h"

namespace vinerow::sensors::encoders_test {
namespace {

using test::SensorBench;

std::unique_ptr<Sensor> make(SensorBench& bench, const test::SensorValues& values,
                             bool with_outage = false) {
  ParameterSet parameters = test::sensor_parameters("encoders", values);
  if (with_outage) parameters = test::with_outage(parameters, 1.0, 2.0);
  auto sensor = make_encoders(parameters, bench.context(50.0));
  bench.connect(*sensor);
  return sensor;
}

const test::SensorValues kIdeal = {{"angle_resolution_rad", 0.0},
                                   {"angle_noise_std_rad", 0.0},
                                   {"speed_resolution_radps", 0.0},
                                   {"speed_noise_std_radps", 0.0}};

TEST(Encoders, IdealReadingIsTheTruthUnderTheActuatorsNames) {
  SensorBench bench;
  bench.vehicle.states = {0.123456789, -3.21};
  auto encoders = make(bench, kIdeal);
  encoders->step(Time{0});
  const NamedValues& reading = bench.bus.subscribe<NamedValues>("rover/s", "test").value();
  EXPECT_EQ(reading.names, (std::vector<std::string>{"axle_steer_rad", "wheel_speed_radps"}));
  EXPECT_EQ(reading.values, (std::vector<double>{0.123456789, -3.21}));
}

TEST(Encoders, ResolutionRoundsToTheNearestStepOfItsKind) {
  SensorBench bench;
  auto encoders = make(bench, {{"angle_resolution_rad", 0.02},
                               {"angle_noise_std_rad", 0.0},
                               {"speed_resolution_radps", 0.5},
                               {"speed_noise_std_radps", 0.0}});
  const auto reading = bench.bus.subscribe<NamedValues>("rover/s", "test");
  bench.vehicle.states = {0.129, -3.2};
  encoders->step(Time{0});
  EXPECT_NEAR(reading.value().values[0], 0.12, 1e-15);
  EXPECT_NEAR(reading.value().values[1], -3.0, 1e-15);
  bench.vehicle.states = {0.131, -3.3};
  encoders->step(Time{20'000'000});
  EXPECT_NEAR(reading.value().values[0], 0.14, 1e-15);
  EXPECT_NEAR(reading.value().values[1], -3.5, 1e-15);
}

TEST(Encoders, NoiseHasItsStandardDeviationAndIsWhite) {
  SensorBench bench;
  auto encoders = make(bench, {{"angle_resolution_rad", 0.0},
                               {"angle_noise_std_rad", 0.001},
                               {"speed_resolution_radps", 0.0},
                               {"speed_noise_std_radps", 0.05}});
  const auto reading = bench.bus.subscribe<NamedValues>("rover/s", "test");
  constexpr int kCount = 20'000;
  double angle = 0.0, speed = 0.0, lagged = 0.0, cross = 0.0, last = 0.0;
  for (int i = 0; i < kCount; ++i) {
    encoders->step(Time{i * 20'000'000LL});
    const double a = (reading.value().values[0] - 0.1) / 0.001;
    const double v = (reading.value().values[1] + 3.0) / 0.05;
    angle += a * a / kCount, speed += v * v / kCount, cross += a * v / kCount;
    lagged += a * last / kCount;
    last = a;
  }
  // Five standard errors: sqrt(2 / n) for a variance, sqrt(1 / n) for a correlation.
  EXPECT_NEAR(angle, 1.0, 5.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(speed, 1.0, 5.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(cross, 0.0, 5.0 / std::sqrt(kCount));
  EXPECT_NEAR(lagged, 0.0, 5.0 / std::sqrt(kCount));
}

TEST(Encoders, OutageReadsInfinityAndDoesNotShiftTheNoise) {
  SensorBench a, b;
  auto plain = make(a, {}), broken = make(b, {}, true);
  const auto whole = a.bus.subscribe<NamedValues>("rover/s", "test");
  const auto holed = b.bus.subscribe<NamedValues>("rover/s", "test");
  for (int i = 0; i < 150; ++i) {
    const Time now{i * 20'000'000LL};
    plain->step(now), broken->step(now);
    if (i >= 50 && i < 100) {
      EXPECT_TRUE(std::isinf(holed.value().values[0]) && std::isinf(holed.value().values[1])) << i;
    } else {
      EXPECT_EQ(whole.value().values, holed.value().values) << i;
    }
  }
}

TEST(Encoders, DelayedReadingsKeepTheirTimeAndAllocateNothing) {
  SensorBench bench;
  auto values = kIdeal;
  values.emplace_back("delay_s", 0.05);
  auto encoders = make(bench, values);
  ASSERT_EQ(encoders->delay().ns, 50'000'000);
  const auto reading = bench.bus.subscribe<NamedValues>("rover/s", "test");
  for (int i = 0; i < 3; ++i) {
    bench.vehicle.states[0] = 0.01 * i;
    encoders->step(Time{i * 20'000'000LL});
  }
  EXPECT_FALSE(reading.has_value());
  encoders->deliver(Time{50'000'000});
  EXPECT_EQ(reading.stamp().ns, 0);
  encoders->step(Time{60'000'000});
  encoders->deliver(Time{70'000'000});
  EXPECT_EQ(reading.stamp().ns, 20'000'000);
  EXPECT_EQ(reading.value().values[0], 0.01);
  const test::AllocationCounter counter;
  for (int i = 4; i < 40; ++i) {
    encoders->step(Time{i * 20'000'000LL});
    encoders->deliver(Time{i * 20'000'000LL + 10'000'000});
  }
  EXPECT_EQ(counter.count(), 0u);
}

TEST(Encoders, SaysWhichVehicleTellsNothing) {
  SensorBench bench;
  bench.vehicle.states.clear();
  try {
    make(bench, {});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "rover.sensors.s: encoders measure the states of a vehicle's actuators, which "
                 "vehicle type 'fixed' does not have");
  }
  bench.vehicle.states = {0.0, 0.0};
  bench.vehicle.description_.actuators[1].unit = "N";
  try {
    make(bench, {});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "rover.sensors.s: actuator 'wheel_speed_radps' is in N; encoders measure rad and "
                 "rad/s only");
  }
}

}  // namespace
}  // namespace vinerow::sensors::encoders_test
