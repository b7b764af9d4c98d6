/// The inertial sensors' noise by its Allan deviation, against what data sheets say.

#include "engine/api/messages/sensors.h"
#include "engine/core/random.h"
#include "tests/support/allan_deviation.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/engine/sensors/data_sheet.h"
#include "tests/engine/sensors/sensor_rig.h"

namespace vinerow::sensors::allan_test {
namespace {

using test::AllanDeviation;
using test::SensorRig;
using test::SensorValues;

constexpr int kHour = 360'000;  // samples at 100 Hz
constexpr double kGravity = 9.80665;

TEST(AllanDeviationItself, OfARampIsTheRateTimesTheTimeOverRootTwo) {
  std::vector<double> ramp;
  for (int i = 0; i < 2'000; ++i) ramp.push_back(3.0 * 0.01 * i);
  const AllanDeviation allan(ramp, 0.01);
  // Closed form, without scatter: IEEE 952, equation C.19.
  for (const std::size_t n : {1, 10, 100, 700}) {
    EXPECT_NEAR(allan.deviation(n), 3.0 * 0.01 * static_cast<double>(n) / std::sqrt(2.0), 1e-9);
  }
}

TEST(AllanDeviationItself, OfWhiteNoiseAndOfARandomWalkIsTheirClosedForm) {
  RandomStream random(5, "test", "allan");
  std::vector<double> white, walk;
  double sum = 0.0;
  for (int i = 0; i < kHour; ++i) {
    white.push_back(0.2 / std::sqrt(0.01) * random.normal());
    walk.push_back(sum += 0.3 * std::sqrt(0.01) * random.normal());
  }
  const AllanDeviation of_white(white, 0.01), of_walk(walk, 0.01);
  for (const std::size_t n : {10, 100, 1'000}) {  // at least 360 independent clusters: 5 %
    const double time_s = 0.01 * static_cast<double>(n);
    EXPECT_NEAR(of_white.deviation(n) * std::sqrt(time_s) / 0.2, 1.0, 0.1) << n;
    EXPECT_NEAR(of_walk.deviation(n) / std::sqrt(time_s / 3.0) / 0.3, 1.0, 0.1) << n;
  }
}

/// Mean Allan variances of three axes over some runs, of gyro and accelerometer.
class HourOfRecords {
 public:
  HourOfRecords(const ParameterSet& parameters, int runs) {
    for (int run = 1; run <= runs; ++run) {
      SensorRig<ImuSample> rig("imu", parameters, 100.0, static_cast<std::uint64_t>(run));
      std::array<std::vector<double>, 6> records;
      for (auto& record : records) record.reserve(kHour);
      for (int i = 0; i < kHour; ++i) {
        const ImuSample& sample = rig.read();
        for (int axis = 0; axis < 3; ++axis) {
          records[axis].push_back(sample.w_WS_S[axis]);
          records[3 + axis].push_back(sample.f_WS_S[axis]);
        }
      }
      for (int i = 0; i < 6; ++i) (i < 3 ? gyro_ : accelerometer_).emplace_back(records[i], 0.01);
    }
  }
  double gyro(std::size_t n) const { return mean(gyro_, n); }
  double accelerometer(std::size_t n) const { return mean(accelerometer_, n); }

 private:
  static double mean(const std::vector<AllanDeviation>& records, std::size_t n) {
    double sum = 0.0;
    for (const AllanDeviation& record : records) sum += record.variance(n);
    return std::sqrt(sum / static_cast<double>(records.size()));
  }
  std::vector<AllanDeviation> gyro_, accelerometer_;
};

/// The data sheets' own figures, in their own units.
struct Sheet {
  const char* file;
  double gyro_noise_dps_rtHz, gyro_instability_dph;
  double accelerometer_noise_ug_rtHz, accelerometer_instability_ug;
};

void PrintTo(const Sheet& sheet, std::ostream* out) {
  *out << sheet.file;
}

class ImuDataSheet : public ::testing::TestWithParam<Sheet> {};

// One axis of one hour scatters by 24 % at the longest time here (five to nine independent
// clusters), 18 of them by 6 %: three axes of six runs are averaged before they are judged.
TEST_P(ImuDataSheet, AnHoursRecordHasItsAllanDeviation) {
  const Sheet& sheet = GetParam();
  const HourOfRecords hour(test::data_sheet(sheet.file).parameters, 6);
  const double rad = rad_from_deg(1.0), ug = 1e-6 * kGravity;
  for (const std::size_t n : {8, 16, 32}) {
    const double root_time = std::sqrt(0.01 * static_cast<double>(n));
    EXPECT_NEAR(hour.gyro(n) * root_time / rad / sheet.gyro_noise_dps_rtHz, 1.0, 0.1) << n;
    EXPECT_NEAR(hour.accelerometer(n) * root_time / ug / sheet.accelerometer_noise_ug_rtHz, 1.0,
                0.1)
        << n;
  }
  double min_gyro = 1e9, min_accelerometer = 1e9;
  for (std::size_t n = 1; n <= 32'768; n *= 2) {  // 328 s: eleven clusters of an hour
    min_gyro = std::min(min_gyro, hour.gyro(n));
    min_accelerometer = std::min(min_accelerometer, hour.accelerometer(n));
  }
  // IEEE 952, equation C.5: the least value is sqrt(2 ln 2 / pi) = 0.664 times the instability.
  EXPECT_NEAR(min_gyro / 0.664 / rad * 3600.0 / sheet.gyro_instability_dph, 1.0, 0.1);
  EXPECT_NEAR(min_accelerometer / 0.664 / ug / sheet.accelerometer_instability_ug, 1.0, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Shipped, ImuDataSheet,
                         ::testing::Values(Sheet{"vn200_imu", 0.0035, 6.0, 140.0, 40.0},
                                           Sheet{"mti10_imu", 0.03, 18.0, 60.0, 15.0}),
                         [](const auto& sheet) { return std::string(sheet.param.file); });

TEST(ImuNoise, ItsRandomWalkGrowsWithTheRootOfTheTime) {
  const HourOfRecords hour(test::sensor_parameters("imu", {{"gyro_noise_dps_rtHz", 0.001},
                                                           {"gyro_walk_dps2_rtHz", 0.002},
                                                           {"accel_noise_mps2_rtHz", 0.0001},
                                                           {"accel_walk_mps3_rtHz", 0.0003}}),
                           1);
  for (const std::size_t n : {1'000, 2'000, 4'000}) {  // 90 clusters and more of three axes: 4 %
    const double root = std::sqrt(0.01 * static_cast<double>(n) / 3.0);
    EXPECT_NEAR(hour.gyro(n) / root / rad_from_deg(0.002), 1.0, 0.1) << n;
    EXPECT_NEAR(hour.accelerometer(n) / root / 0.0003, 1.0, 0.1) << n;
  }
}

TEST(ImuNoise, AnInstabilityBelowTheWhiteNoiseIsRefused) {
  try {
    SensorRig<ImuSample> rig(
        "imu", SensorValues{{"gyro_noise_dps_rtHz", 0.1}, {"gyro_bias_instability_dph", 1.0}},
        100.0);
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    // White noise of 360 deg/h at 1 s is 18 deg/h at 400 s.
    EXPECT_STREQ(
        error.what(),
        "gyro_bias_instability_dph = 1 deg/h requires a minimum Allan deviation of "
        "0.664282 deg/h, but white noise and random walk alone are 18 deg/h or more up to 400 s");
  }
}

}  // namespace
}  // namespace vinerow::sensors::allan_test
