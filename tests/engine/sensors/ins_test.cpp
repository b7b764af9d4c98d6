#include <gtest/gtest.h>

#include "engine/math/angles.h"
#include "tests/engine/sensors/data_sheet.h"
#include "tests/engine/sensors/sensor_rig.h"
#include "tests/support/no_alloc.h"

namespace vinerow::sensors::ins_test {
namespace {

using Eigen::Vector3d;
using test::Moments;
using test::SensorRig;
using test::SensorValues;
using Rig = SensorRig<Odometry>;

Odometry flying() {
  Odometry truth;
  truth.X_WB = {quaternion_from_rpy({0.2, -0.3, 2.0}), {10.0, 20.0, 3.0}};
  truth.v_WB_B = {5.0, 0.5, -0.2};
  truth.w_WB_B = {0.1, -0.2, 0.3};
  return truth;
}

/// Rotation from the truth to the reading, as a vector in W.
Vector3d attitude_error(const Odometry& reading, const Odometry& truth) {
  const Eigen::AngleAxisd turn(reading.X_WB.q * truth.X_WB.q.conjugate());
  return turn.angle() * turn.axis();
}

void expect_std(const Moments& moments, double std, double independent) {
  // Five standard errors of the mean square.
  EXPECT_NEAR(moments.mean_square() / (std * std), 1.0, 5.0 * std::sqrt(2.0 / independent));
}

TEST(Ins, WhiteErrorsHaveTheirSizesAndNoMemory) {
  Rig rig("ins",
          SensorValues{{"position_white_share", 1.0},
                       {"velocity_white_share", 1.0},
                       {"attitude_white_share", 1.0}},
          100.0);
  const Odometry truth = flying();
  const Vector3d v_W = truth.X_WB.q * truth.v_WB_B;
  constexpr int kCount = 20'000;
  std::array<Moments, 3> position, velocity, attitude, rate;
  for (int i = 0; i < kCount; ++i) {
    const Odometry& reading = rig.read(truth);
    const Vector3d turn = attitude_error(reading, truth);
    for (int axis = 0; axis < 3; ++axis) {
      position[axis].add(reading.X_WB.p[axis] - truth.X_WB.p[axis]);
      velocity[axis].add((reading.X_WB.q * reading.v_WB_B - v_W)[axis]);
      attitude[axis].add(deg_from_rad(turn[axis]));
      rate[axis].add(deg_from_rad(reading.w_WB_B[axis] - truth.w_WB_B[axis]));
    }
  }
  // Paper C, table 2; 0.0035 deg/s/sqrt(Hz) at 100 Hz.
  const Vector3d position_std(1.0, 1.0, 1.5), attitude_std(0.03, 0.03, 0.2);
  for (int axis = 0; axis < 3; ++axis) {
    expect_std(position[axis], position_std[axis], kCount);
    expect_std(velocity[axis], 0.05, kCount);
    expect_std(attitude[axis], attitude_std[axis], kCount);
    expect_std(rate[axis], 0.035, kCount);
    for (const auto* m : {&position[axis], &velocity[axis], &attitude[axis], &rate[axis]}) {
      EXPECT_NEAR(m->mean() / std::sqrt(m->mean_square()), 0.0, 5.0 / std::sqrt(kCount));
      EXPECT_NEAR(m->correlation(), 0.0, 5.0 / std::sqrt(kCount));
    }
  }
}

TEST(Ins, SlowErrorsForgetAsTheyAreTold) {
  // At 2 Hz, so that an hour and a half holds many correlation times.
  Rig rig(
      "ins",
      SensorValues{{"position_time_s", 2.0}, {"velocity_time_s", 5.0}, {"attitude_time_s", 1.0}},
      2.0);
  const Odometry truth = flying();
  const Vector3d v_W = truth.X_WB.q * truth.v_WB_B;
  constexpr int kCount = 100'000;
  Moments position, velocity, yaw;
  for (int i = 0; i < kCount; ++i) {
    const Odometry& reading = rig.read(truth);
    position.add(reading.X_WB.p.z() - truth.X_WB.p.z());
    velocity.add((reading.X_WB.q * reading.v_WB_B - v_W).x());
    yaw.add(deg_from_rad(attitude_error(reading, truth).z()));
  }
  // Correlation exp(-0.5 s / time); independent samples: kCount (1 - r^2) / (1 + r^2).
  const auto expect_process = [&](const Moments& moments, double std, double time_s) {
    const double r = std::exp(-0.5 / time_s);
    expect_std(moments, std, kCount * (1.0 - r * r) / (1.0 + r * r));
    EXPECT_NEAR(moments.correlation(), r, 5.0 * std::sqrt((1.0 - r * r) / kCount));
  };
  expect_process(position, 1.5, 2.0);
  expect_process(velocity, 0.05, 5.0);
  expect_process(yaw, 0.2, 1.0);
}

TEST(Ins, AMixedErrorKeepsItsVarianceAndSharesItsMemory) {
  Rig rig("ins", SensorValues{{"position_white_share", 0.25}, {"position_time_s", 2.0}}, 2.0);
  constexpr int kCount = 100'000;
  Moments east;
  for (int i = 0; i < kCount; ++i) east.add(rig.read().X_WB.p.x());
  const double r = std::exp(-0.25);
  expect_std(east, 1.0, kCount * (1.0 - r * r) / (1.0 + r * r));
  EXPECT_NEAR(east.correlation(), 0.75 * r, 5.0 / std::sqrt(kCount));
}

TEST(Ins, ItStatesItsAccuracyAndTheTruthHasNone) {
  Rig rig("ins", SensorValues{}, 100.0);
  const Odometry truth = flying();
  const Odometry& reading = rig.read(truth);
  EXPECT_NEAR(
      (reading.position_covariance() - Vector3d(1.0, 1.0, 2.25).asDiagonal().toDenseMatrix())
          .norm(),
      0.0, 1e-12);
  EXPECT_NEAR(reading.yaw_std_rad, rad_from_deg(0.2), 1e-15);
  EXPECT_EQ(rig.true_reading->value().X_WB.p, truth.X_WB.p);
  EXPECT_EQ(rig.true_reading->value().position_variance_m2, Vector3d::Zero().eval());
}

TEST(Ins, WithoutErrorsItIsTheTruth) {
  Rig rig("ins",
          SensorValues{{"horizontal_std_m", 0.0},
                       {"vertical_std_m", 0.0},
                       {"velocity_std_mps", 0.0},
                       {"roll_pitch_std_deg", 0.0},
                       {"yaw_std_deg", 0.0},
                       {"rate_noise_dps_rtHz", 0.0}},
          100.0);
  const Odometry truth = flying(), reading = rig.read(truth);
  EXPECT_EQ(reading.X_WB.p, truth.X_WB.p);
  EXPECT_LT(reading.X_WB.q.angularDistance(truth.X_WB.q), 1e-15);
  EXPECT_NEAR((reading.v_WB_B - truth.v_WB_B).norm(), 0.0, 1e-14);
  EXPECT_EQ(reading.w_WB_B, truth.w_WB_B);
}

TEST(Ins, AnOutageIsSilenceAndShiftsNoNoise) {
  Rig plain("ins", SensorValues{}, 100.0);
  Rig broken("ins", test::with_outage(test::sensor_parameters("ins"), 0.1, 0.2), 100.0);
  for (int i = 0; i < 40; ++i) {
    const Vector3d p = plain.read().X_WB.p;
    const Vector3d q = broken.read().X_WB.p;
    const bool out = i >= 10 && i < 20;
    EXPECT_EQ(broken.reading->stamp() == broken.now, !out) << i;
    EXPECT_EQ(p == q, !out) << i;
  }
}

TEST(Ins, AStepAllocatesNothing) {
  Rig rig("ins", test::data_sheet("vn200_ins").parameters, 100.0);
  rig.read(flying());
  const test::AllocationCounter counter;
  for (int i = 0; i < 100; ++i) rig.read(flying());
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_FALSE(rig.bench.bus.find("rover/s")->has_nan());
}

}  // namespace
}  // namespace vinerow::sensors::ins_test
