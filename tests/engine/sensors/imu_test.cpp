#include <gtest/gtest.h>

#include "engine/api/messages/sensors.h"
#include "engine/math/angles.h"
#include "tests/engine/sensors/data_sheet.h"
#include "tests/engine/sensors/sensor_rig.h"
#include "tests/support/no_alloc.h"

namespace vinerow::sensors::imu_test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using test::Moments;
using test::SensorRig;
using test::SensorValues;
using Rig = SensorRig<ImuSample>;

constexpr double kGravity = 9.80665;

/// Without noise, with the other values given.
SensorValues silent(SensorValues more = {}) {
  more.emplace_back("gyro_noise_dps_rtHz", 0.0);
  more.emplace_back("accel_noise_mps2_rtHz", 0.0);
  return more;
}

/// A body that rocks and turns by several degrees within a period of the unit (0.01 s) while it is
/// shaken: at time t.
Odometry shaken(double t) {
  Odometry truth;
  const double roll = 0.4 * std::sin(31.0 * t), pitch = 0.3 * std::cos(47.0 * t), yaw = 2.0 * t;
  truth.X_WB.q = quaternion_from_rpy({roll, pitch, yaw});
  // Angular velocity from the angles' rates: roll about body x, pitch about y before roll, yaw up.
  const Vector3d w_W =
      Vector3d(0, 0, 2.0) +
      quaternion_from_rpy({0, 0, yaw}) * Vector3d(0, -0.3 * 47.0 * std::sin(47.0 * t), 0) +
      quaternion_from_rpy({0, pitch, yaw}) * Vector3d(0.4 * 31.0 * std::cos(31.0 * t), 0, 0);
  truth.w_WB_B = truth.X_WB.q.conjugate() * w_W;
  truth.v_WB_B = truth.X_WB.q.conjugate() *
                 Vector3d(3.0 + std::sin(40.0 * t), std::cos(23.0 * t), 0.5 * std::sin(60.0 * t));
  return truth;
}

TEST(Imu, StrapdownIntegrationFollowsTheTruthWhateverHappensBetweenReadings) {
  const Vector3d p_BS(0.2, -0.1, 0.3);
  Rig rig("imu",
          silent({{"position_m", std::vector<double>{0.2, -0.1, 0.3}},
                  {"accel_range_mps2", 1e4},
                  {"rotation_deg", std::vector<double>{180.0, 10.0, -30.0}}}),
          100.0);
  const Quaterniond q_BS = quaternion_from_rpy({kPi, rad_from_deg(10.0), rad_from_deg(-30.0)});
  const auto v_WS = [&](const Odometry& truth) -> Vector3d {
    return truth.X_WB.q * (truth.v_WB_B + truth.w_WB_B.cross(p_BS));
  };
  rig.read(shaken(0.0));
  Quaterniond q_WS = shaken(0.0).X_WB.q * q_BS;
  Vector3d v = v_WS(shaken(0.0));
  for (int i = 1; i <= 1'000; ++i) {
    const ImuSample& sample = rig.read(shaken(0.01 * i));
    // A navigation computer: half of the turn, the force, the other half.
    const Vector3d turn = 0.01 * sample.w_WS_S;
    const Quaterniond half(Eigen::AngleAxisd(0.5 * turn.norm(), turn.normalized()));
    q_WS = q_WS * half;
    v += 0.01 * (q_WS * sample.f_WS_S - Vector3d(0, 0, kGravity));
    q_WS = (q_WS * half).normalized();
  }
  const Odometry end = shaken(10.0);
  EXPECT_LT(q_WS.angularDistance(end.X_WB.q * q_BS), 1e-9);
  EXPECT_LT((v - v_WS(end)).norm(), 1e-9);
}

TEST(Imu, ItsMeansAreThoseOfASlowMotion) {
  // Turning about z at 0.5 t, sensor 0.4 m ahead: tangential 0.2 m/s2, centripetal (0.5 t)^2 0.4.
  Rig rig("imu", silent({{"position_m", std::vector<double>{0.4, 0.0, 0.0}}}), 100.0);
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.01 * i;
    Odometry truth;
    truth.X_WB.q = quaternion_from_rpy({0, 0, 0.25 * t * t});
    truth.w_WB_B = {0, 0, 0.5 * t};
    const ImuSample& sample = rig.read(truth);
    if (i == 0) continue;
    const double middle = t - 0.005;  // the mean of what grows linearly
    EXPECT_NEAR(sample.w_WS_S.z(), 0.5 * middle, 1e-12);
    EXPECT_NEAR(sample.f_WS_S.y(), 0.2, 1e-4);
    EXPECT_NEAR(sample.f_WS_S.x(), -std::pow(0.5 * middle, 2) * 0.4, 1e-4);
    EXPECT_NEAR(sample.f_WS_S.z(), kGravity, 1e-12);
  }
}

// The first reading is instantaneous: the specific force of the centre of mass and, on a lever r,
// the centripetal w x (w x r), which points to the axis.
TEST(Imu, TheFirstReadingHasTheLeverArmsCentripetalForce) {
  Rig rig("imu",
          silent({{"position_m", std::vector<double>{0.4, -0.1, 0.2}},
                  {"rotation_deg", std::vector<double>{0.0, 0.0, 90.0}}}),
          100.0);
  rig.bench.vehicle.specific_force = {1.0, 2.0, 9.0};
  Odometry truth;
  truth.w_WB_B = {0.0, 0.0, 3.0};
  const ImuSample& sample = rig.read(truth);
  // In B: (1, 2, 9) - 9 (0.4, -0.1, 0); S looks along y of B, so f_S = (f_y, -f_x, f_z).
  EXPECT_NEAR((sample.f_WS_S - Vector3d(2.0 + 0.9, -(1.0 - 3.6), 9.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((sample.w_WS_S - Vector3d(0, 0, 3.0)).norm(), 0.0, 1e-12);
}

TEST(Imu, GivenScaleErrorsAndMisalignmentsAreLinear) {
  Rig rig("imu",
          silent({{"gyro_scale_errors", std::vector<double>{0.01, 0.0, -0.02}},
                  {"accel_misalignments_deg", std::vector<double>{0, 0, 0, 0, 1.0, -2.0}},
                  {"accel_scale_errors", std::vector<double>{0.0, 0.0, 0.001}}}),
          100.0);
  Odometry truth;
  truth.w_WB_B = {1.0, 2.0, 3.0};
  rig.bench.vehicle.specific_force = {2.0, 4.0, 10.0};
  const ImuSample& sample = rig.read(truth);
  EXPECT_NEAR((sample.w_WS_S - Vector3d(1.01, 2.0, 2.94)).norm(), 0.0, 1e-12);
  // z leans by 1 deg towards x and by -2 deg towards y.
  const double z = 10.01 + rad_from_deg(1.0) * 2.0 - rad_from_deg(2.0) * 4.0;
  EXPECT_NEAR((sample.f_WS_S - Vector3d(2.0, 4.0, z)).norm(), 0.0, 1e-12);
  EXPECT_EQ(rig.true_reading->value().w_WS_S, truth.w_WB_B) << "the truth has none of this";
}

TEST(Imu, WhatBelongsToTheDeviceIsDrawnOncePerRunWithItsSpread) {
  Moments bias, scale, lean, g_sensitivity;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    Rig rig("imu",
            silent({{"gyro_bias_std_dps", 0.2},
                    {"accel_scale_error_std", 0.01},
                    {"accel_misalignment_std_deg", 0.5},
                    {"gyro_g_sensitivity_std_dps_per_g", 0.1}}),
            100.0, static_cast<std::uint64_t>(run));
    rig.bench.vehicle.specific_force = {0, 0, kGravity};
    const ImuSample upright = rig.read(), again = rig.read();
    EXPECT_EQ(upright.w_WS_S, again.w_WS_S);
    Rig falling("imu",
                silent({{"gyro_bias_std_dps", 0.2}, {"gyro_g_sensitivity_std_dps_per_g", 0.1}}),
                100.0, static_cast<std::uint64_t>(run));
    falling.bench.vehicle.specific_force.setZero();
    const ImuSample& weightless = falling.read();
    for (int axis = 0; axis < 3; ++axis) {
      bias.add(deg_from_rad(weightless.w_WS_S[axis]));
      g_sensitivity.add(deg_from_rad(upright.w_WS_S[axis] - weightless.w_WS_S[axis]));
    }
    scale.add(upright.f_WS_S.z() / kGravity - 1.0);
    lean.add(deg_from_rad(upright.f_WS_S.x() / kGravity));
    lean.add(deg_from_rad(upright.f_WS_S.y() / kGravity));
  }
  const auto expect_std = [](const Moments& moments, double std) {
    // Five standard errors of mean and mean square.
    const double n = static_cast<double>(moments.count());
    EXPECT_NEAR(moments.mean() / std, 0.0, 5.0 / std::sqrt(n));
    EXPECT_NEAR(moments.mean_square() / (std * std), 1.0, 5.0 * std::sqrt(2.0 / n));
  };
  expect_std(bias, 0.2);
  expect_std(scale, 0.01);
  expect_std(lean, 0.5);
  expect_std(g_sensitivity, 0.1);
}

TEST(Imu, TheResolutionRoundsAndTheRangeLimits) {
  Rig rig("imu",
          silent({{"gyro_resolution_dps", 0.02},
                  {"accel_resolution_mps2", 0.25},
                  {"accel_range_mps2", 9.9}}),
          100.0);
  Odometry truth;
  truth.w_WB_B = {rad_from_deg(0.029), rad_from_deg(-0.031), rad_from_deg(0.0099)};
  rig.bench.vehicle.specific_force = {0.13, -0.12, 20.0};
  const ImuSample& sample = rig.read(truth);
  EXPECT_NEAR((sample.w_WS_S - Vector3d(0.02, -0.04, 0.0) * rad_from_deg(1.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((sample.f_WS_S - Vector3d(0.25, 0.0, 9.9)).norm(), 0.0, 1e-12);
}

TEST(Imu, AWanderingBiasShiftsNoWhiteNoise) {
  Rig plain("imu", SensorValues{}, 100.0),
      wandering("imu", SensorValues{{"gyro_bias_instability_dph", 60.0}}, 100.0);
  Vector3d bias = Vector3d::Zero();
  for (int i = 0; i < 100; ++i) {
    const ImuSample a = plain.read(), b = wandering.read();
    EXPECT_EQ(a.f_WS_S, b.f_WS_S);
    const Vector3d difference = b.w_WS_S - a.w_WS_S;
    // A bias moves by a hundredth of what white noise of 0.035 deg/s does.
    if (i > 0) {
      EXPECT_LT((difference - bias).norm(), rad_from_deg(0.01));
    }
    bias = difference;
  }
  EXPECT_GT(bias.norm(), 0.0);
}

TEST(Imu, AnOutageIsSilenceAndTheTruthStands) {
  Rig rig("imu", test::with_outage(test::sensor_parameters("imu"), 0.5, 1.0), 100.0);
  for (int i = 0; i < 150; ++i) {
    rig.read();
    const bool out = i >= 50 && i < 100;
    EXPECT_EQ(rig.reading->stamp() == rig.now, !out) << i;
    EXPECT_EQ(rig.true_reading->stamp(), rig.now) << i;
  }
  EXPECT_EQ(rig.reading->sequence(), 100u);
}

TEST(Imu, AStepWithEverythingOnAllocatesNothing) {
  Rig rig("imu", test::data_sheet("mti10_imu").parameters, 100.0);
  rig.read();
  const test::AllocationCounter counter;
  for (int i = 0; i < 100; ++i) rig.read(shaken(0.01 * i));
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_FALSE(rig.bench.bus.find("rover/s")->has_nan());
}

}  // namespace
}  // namespace vinerow::sensors::imu_test
