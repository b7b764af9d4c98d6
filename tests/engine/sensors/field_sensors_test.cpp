/// Barometer and magnetometer.

#include <gtest/gtest.h>

#include "engine/api/messages/sensors.h"
#include "engine/io/files/yaml.h"
#include "engine/math/angles.h"
#include "tests/engine/sensors/data_sheet.h"
#include "tests/engine/sensors/sensor_rig.h"
#include "tests/support/no_alloc.h"
#include "tests/support/paths.h"

namespace vinerow::sensors::field_sensors_test {
namespace {

using Eigen::Vector3d;
using test::Moments;
using test::SensorRig;
using test::SensorValues;
using Barometer = SensorRig<PressureSample>;
using Magnetometer = SensorRig<MagneticSample>;

const GeoOrigin kBarolo{rad_from_deg(44.61), rad_from_deg(7.94), 450.0};

SensorValues quiet_barometer(SensorValues more = {}) {
  for (const char* name : {"noise_std_Pa", "drift_std_Pa", "bias_std_Pa"}) {
    more.emplace_back(name, 0.0);
  }
  return more;
}

/// US Standard Atmosphere 1976, lowest layer, in closed form.
double standard_pressure_Pa(double altitude_m) {
  const double height_m = 6'356'766.0 * altitude_m / (6'356'766.0 + altitude_m);
  return 101'325.0 * std::pow(1.0 - 0.0065 * height_m / 288.15, 5.255876);
}

TEST(BarometerSensor, ReadsTheStandardAtmosphereAtItsOwnAltitude) {
  Barometer rig("barometer", quiet_barometer({{"position_m", std::vector<double>{0.0, 0.0, -2.0}}}),
                50.0, 1, kBarolo);
  Odometry truth;
  truth.X_WB.p = {30.0, -40.0, 12.0};
  EXPECT_NEAR(rig.read(truth).pressure_Pa, standard_pressure_Pa(460.0), 0.02);
  // Half a turn about x: what hung below is above.
  truth.X_WB.q = quaternion_from_rpy({kPi, 0.0, 0.0});
  EXPECT_NEAR(rig.read(truth).pressure_Pa, standard_pressure_Pa(464.0), 0.02);
}

TEST(BarometerSensor, TheDaysPressureScalesAndTheWindEnters) {
  Barometer rig(
      "barometer",
      quiet_barometer({{"sea_level_pressure_Pa", 102'338.25}, {"dynamic_pressure_share", 0.1}}),
      50.0);
  rig.bench.vehicle.air_velocity = {0.0, 12.0, -5.0};
  // 1 % more than 101325 Pa; 0.1 rho v^2 / 2 with rho 1 % above 1.225 kg/m3 and v = 13 m/s.
  EXPECT_NEAR(rig.read().pressure_Pa, 102'338.25 + 0.05 * 1.23725 * 169.0, 1e-3);
  EXPECT_NEAR(rig.true_reading->value().pressure_Pa, 102'338.25, 1e-6);
}

TEST(BarometerSensor, NoiseDriftAndBiasHaveTheirSizes) {
  constexpr int kRuns = 200, kCount = 500;
  Moments bias, all;
  for (int run = 0; run < kRuns; ++run) {
    Barometer rig("barometer",
                  SensorValues{{"noise_std_Pa", 2.0},
                               {"drift_std_Pa", 3.0},
                               {"drift_time_s", 0.05},
                               {"bias_std_Pa", 20.0}},
                  50.0, static_cast<std::uint64_t>(run));
    double sum = 0.0;
    std::vector<double> errors;
    for (int i = 0; i < kCount; ++i) {
      errors.push_back(rig.read().pressure_Pa - 101'325.0);
      sum += errors.back() / kCount;
    }
    bias.add(sum);
    for (const double error : errors) all.add(error - sum);
    EXPECT_NEAR(rig.reading->value().std_Pa, std::sqrt(4.0 + 9.0 + 400.0), 1e-12);
  }
  EXPECT_NEAR(bias.mean_square() / 400.0, 1.0, 5.0 * std::sqrt(2.0 / kRuns));
  // Variance 4 + 9; covariance after one sample 9 exp(-0.02 / 0.05).
  EXPECT_NEAR(all.mean_square(), 13.0, 0.26);
  EXPECT_NEAR(all.correlation(), 9.0 * std::exp(-0.4) / 13.0, 0.02);
}

TEST(BarometerSensor, RoundsToItsResolution) {
  Barometer rig("barometer", quiet_barometer({{"resolution_Pa", 10.0}}), 50.0);
  EXPECT_DOUBLE_EQ(rig.read().pressure_Pa, 101'330.0);
}

SensorValues quiet_magnetometer(SensorValues more = {}) {
  more.emplace_back("noise_std_nT", 0.0);
  return more;
}

TEST(MagnetometerSensor, PointsToMagneticNorth) {
  Magnetometer rig("magnetometer", quiet_magnetometer({{"year", 2026.0}}), 50.0, 1, kBarolo);
  const Vector3d field_uT = 1e6 * rig.read().field_S_T;
  // Level, x to the east. Declination in Piedmont: 3.3 deg to the east; the field dips by 61 deg
  // and has 47.5 uT (isolines of the WMM2025 report, figures 8 to 10, read to the half degree).
  EXPECT_NEAR(deg_from_rad(std::atan2(field_uT.x(), field_uT.y())), 3.3, 0.3);
  EXPECT_NEAR(deg_from_rad(std::atan2(-field_uT.z(), field_uT.head<2>().norm())), 61.0, 0.5);
  EXPECT_NEAR(field_uT.norm(), 47.5, 0.5);

  // The heading of x by compass is the true one less the declination, for every heading.
  for (int i = 0; i < 12; ++i) {
    const double yaw = rad_from_deg(30.0 * i);
    Odometry truth;
    truth.X_WB.q = quaternion_from_rpy({0, 0, yaw});
    const Vector3d f = rig.read(truth).field_S_T;
    const double yaw_from_magnetic_north = -std::atan2(f.y(), f.x());
    const double magnetic_north = kPi / 2.0 - std::atan2(field_uT.x(), field_uT.y());
    EXPECT_NEAR(wrap_angle(yaw_from_magnetic_north + magnetic_north - yaw), 0.0, 1e-12) << i;
  }
}

TEST(MagnetometerSensor, TurnsTheGivenFieldIntoItsOwnAxes) {
  Magnetometer rig("magnetometer",
                   quiet_magnetometer({{"field_uT", std::vector<double>{1.0, 20.0, -40.0}},
                                       {"rotation_deg", std::vector<double>{0.0, 90.0, 0.0}}}),
                   50.0);
  Odometry truth;
  truth.X_WB.q = quaternion_from_rpy({0, 0, kPi / 2});  // body x north, y west
  // x of S looks down, y west, z north.
  EXPECT_NEAR((1e6 * rig.read(truth).field_S_T - Vector3d(40.0, -1.0, 20.0)).norm(), 0.0, 1e-12);
}

TEST(MagnetometerSensor, IronIsAnOffsetAndAMatrix) {
  Magnetometer rig(
      "magnetometer",
      quiet_magnetometer({{"field_uT", std::vector<double>{10.0, 20.0, -40.0}},
                          {"hard_iron_uT", std::vector<double>{1.0, -2.0, 3.0}},
                          {"soft_iron", std::vector<double>{0.1, 0.0, -0.1, 0.01, 0.02, 0.05}}}),
      50.0);
  // (I + M) f + h by hand.
  const Vector3d wanted(11.0 + 0.2 - 0.8 + 1.0, 20.0 + 0.1 - 2.0 - 2.0, -36.0 + 0.2 + 1.0 + 3.0);
  EXPECT_NEAR((1e6 * rig.read().field_S_T - wanted).norm(), 0.0, 1e-12);
  EXPECT_NEAR((1e6 * rig.true_reading->value().field_S_T - Vector3d(10.0, 20.0, -40.0)).norm(), 0.0,
              1e-12);
}

TEST(MagnetometerSensor, NoiseAndIronHaveTheirSpread) {
  constexpr int kRuns = 300;
  Moments hard, soft, noise;
  for (int run = 0; run < kRuns; ++run) {
    const auto seed = static_cast<std::uint64_t>(run);
    const std::vector<double> none{0.0, 0.0, 0.0}, up{0.0, 0.0, 50.0};
    Magnetometer dark("magnetometer",
                      quiet_magnetometer({{"field_uT", none}, {"hard_iron_std_uT", 2.0}}), 50.0,
                      seed);
    Magnetometer bent("magnetometer",
                      quiet_magnetometer({{"field_uT", up}, {"soft_iron_std", 0.02}}), 50.0, seed);
    Magnetometer loud("magnetometer", {{"field_uT", none}, {"noise_std_nT", 30.0}}, 50.0, seed);
    for (int axis = 0; axis < 3; ++axis) {
      hard.add(1e6 * dark.read().field_S_T[axis]);
      soft.add(1e6 / 50.0 * bent.read().field_S_T[axis] - (axis == 2 ? 1.0 : 0.0));
      noise.add(1e9 * loud.read().field_S_T[axis]);
    }
    EXPECT_DOUBLE_EQ(loud.reading->value().std_T, 30e-9);
  }
  const double margin = 5.0 * std::sqrt(2.0 / (3.0 * kRuns));
  EXPECT_NEAR(hard.mean_square() / 4.0, 1.0, margin);
  EXPECT_NEAR(soft.mean_square() / 4e-4, 1.0, margin);
  EXPECT_NEAR(noise.mean_square() / 900.0, 1.0, margin);
}

TEST(MagnetometerSensor, RoundsAndSaturates) {
  Magnetometer rig("magnetometer",
                   quiet_magnetometer({{"field_uT", std::vector<double>{0.017, 900.0, -900.0}},
                                       {"resolution_nT", 13.0}}),
                   50.0);
  EXPECT_NEAR((1e6 * rig.read().field_S_T - Vector3d(0.013, 800.0, -800.0)).norm(), 0.0, 1e-9);
}

TEST(FieldSensors, AnOutageIsSilence) {
  Barometer barometer("barometer",
                      test::with_outage(test::sensor_parameters("barometer"), 0.2, 0.4), 50.0);
  Magnetometer magnetometer(
      "magnetometer", test::with_outage(test::sensor_parameters("magnetometer"), 0.2, 0.4), 50.0);
  for (int i = 0; i < 30; ++i) barometer.read(), magnetometer.read();
  EXPECT_EQ(barometer.reading->sequence(), 20u);
  EXPECT_EQ(magnetometer.reading->sequence(), 20u);
  EXPECT_EQ(barometer.true_reading->sequence(), 30u);
  EXPECT_EQ(magnetometer.true_reading->sequence(), 30u);
}

TEST(FieldSensors, AStepOfAShippedOneAllocatesNothing) {
  Barometer barometer("barometer", test::data_sheet("bmp388").parameters, 50.0);
  Magnetometer magnetometer("magnetometer", test::data_sheet("rm3100").parameters, 50.0);
  barometer.read(), magnetometer.read();
  const test::AllocationCounter counter;
  for (int i = 0; i < 100; ++i) barometer.read(), magnetometer.read();
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_FALSE(barometer.bench.bus.find("rover/s")->has_nan());
  EXPECT_FALSE(magnetometer.bench.bus.find("rover/s")->has_nan());
}

/// A number without a source is somebody's guess.
TEST(DataSheets, EveryNumberHasASource) {
  for (const char* sheet : {"vn200_imu", "mti10_imu", "vn200_ins", "bmp388", "rm3100"}) {
    const io::YamlNode tree = io::load_yaml_file(std::filesystem::path(VINEROW_SOURCE_DIR) /
                                                 "assets/sensors" / (std::string(sheet) + ".yaml"));
    for (const io::YamlEntry& entry : tree.entries) {
      if (entry.key == "type") continue;
      const io::YamlNode* source = entry.value.find("source");
      EXPECT_TRUE(source != nullptr && source->text.size() > 5) << sheet << ": " << entry.key;
      EXPECT_TRUE(entry.value.has("value")) << sheet << ": " << entry.key;
    }
  }
}

}  // namespace
}  // namespace vinerow::sensors::field_sensors_test
