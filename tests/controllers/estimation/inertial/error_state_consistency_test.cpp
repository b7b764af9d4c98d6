// Whether the error-state filter is consistent: many runs with the stated noise.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cstdio>
#include <ostream>
#include <string>

#include "controllers/estimation/inertial/error_state_kalman.h"
#include "controllers/estimation/inertial/navigation_measurements.h"
#include "engine/math/angles.h"
#include "tests/controllers/estimation/inertial/imu_course.h"

namespace vinerow::test::error_state_consistency_test {
namespace {

using I = controllers::ErrorIndex;
using Eigen::Vector3d;

constexpr std::int64_t kPeriod_ns = 10'000'000;
constexpr double kPeriod_s = 0.01;
constexpr int kRuns = 50;
constexpr int kTicks = 6000;
constexpr int kLooks = 6;  // at 10, 20 ... 60 s

struct Unit {
  std::string name;
  controllers::ImuNoise noise;
  double gyro_bias_radps, accel_bias_mps2;
};

/// Data sheets: VectorNav VN-200 (0.0035 deg/s/rtHz, 0.14 mg/rtHz), Xsens MTi-10 series (0.03
/// deg/s/rtHz, 60 ug/rtHz). Biases at switch-on: 0.2 deg/s and 5 mg, 0.2 deg/s and 3 mg.
Unit vn200() {
  return {"vn200",
          {rad_from_deg(0.0035), 0.14e-3 * 9.80665, rad_from_deg(2.8e-4), 3.9e-5},
          rad_from_deg(0.2),
          5e-3 * 9.80665};
}
Unit mti10() {
  return {"mti10",
          {rad_from_deg(0.03), 60e-6 * 9.80665, rad_from_deg(5e-4), 4e-5},
          rad_from_deg(0.2),
          3e-3 * 9.80665};
}

controllers::ErrorCovariance start_of(const Unit& unit) {
  controllers::ErrorVector std;
  std << Vector3d::Constant(0.5), Vector3d::Constant(0.1), Vector3d(0.02, 0.02, 0.035),
      Vector3d::Constant(unit.gyro_bias_radps), Vector3d::Constant(unit.accel_bias_mps2);
  return std.cwiseAbs2().asDiagonal();
}

struct Look {
  controllers::ErrorVector error;
  controllers::ErrorCovariance covariance;
};
struct Flight {
  std::array<Look, kLooks> looks;
  double nis_sum = 0.0;
  int fixes = 0;
};

/// Noise of the world as a share of the noise stated to the filter.
struct NoiseShare {
  double fixes = 1.0, imu = 1.0;
};

/// Fixes 5 Hz, white 0.3 m and 0.1 m/s, antenna off the unit.
Flight run_once(const Unit& unit, int seed, double stated_factor = 1.0, NoiseShare share = {}) {
  const ImuCourse course = lively_course();
  RandomStream random(seed, "test", unit.name);
  const Vector3d arm_B(0.3, -0.2, 0.4);
  controllers::ErrorStateKalmanParams params;
  params.imu = unit.noise;
  controllers::ErrorStateKalman filter(params);
  const controllers::ErrorCovariance P = start_of(unit);
  controllers::NavState truth = course.at(0.0).state;
  controllers::ErrorVector dx;
  for (int i = 0; i < I::kCount; ++i) dx[i] = std::sqrt(P(i, i)) * random.normal();
  // The filter begins with biases of zero; the truth has them.
  Vector3d gyro_bias = dx.segment<3>(I::kGyroBias), accel_bias = dx.segment<3>(I::kAccelBias);
  dx.tail<6>().setZero();
  filter.start(Time{}, truth.plus(-dx), P);

  Flight run;
  const double root = std::sqrt(kPeriod_s);
  for (int i = 0; i <= kTicks; ++i) {
    const Time now = tick_at(i, kPeriod_ns);
    const CoursePoint point = course.at(now.s());
    gyro_bias += share.imu * unit.noise.gyro_walk_radps2_rtHz * root * normal3(random);
    accel_bias += share.imu * unit.noise.accel_walk_mps3_rtHz * root * normal3(random);
    const double gyro_std = share.imu * unit.noise.gyro_radps_rtHz / root;
    const double accel_std = share.imu * unit.noise.accel_mps2_rtHz / root;
    filter.predict(now, point.w_B + gyro_bias + gyro_std * normal3(random),
                   point.f_B + accel_bias + accel_std * normal3(random));
    truth = point.state;
    truth.gyro_bias_B = gyro_bias;
    truth.accel_bias_B = accel_bias;
    if (i % 20 == 0 && i > 0) {
      const Vector3d arm_W = truth.q_WB * arm_B;
      const controllers::VectorMeasurement place = controllers::place_measurement(
          filter.past(now), arm_B, truth.p_WI + arm_W + share.fixes * 0.3 * normal3(random));
      const controllers::Correction correction = filter.correct_vector(
          place.innovation, place.H, Vector3d::Constant(stated_factor * 0.09), 10);
      const controllers::VectorMeasurement velocity = controllers::velocity_measurement(
          filter.past(now), arm_B,
          truth.v_WI + truth.q_WB * point.w_B.cross(arm_B) + share.fixes * 0.1 * normal3(random));
      filter.correct_vector(velocity.innovation, velocity.H,
                            Vector3d::Constant(stated_factor * 0.01), 10);
      run.nis_sum += correction.nis;
      ++run.fixes;
    }
    if (i > 0 && i % 1000 == 0) {
      run.looks[i / 1000 - 1] = {truth.minus(filter.state()), filter.covariance()};
    }
  }
  return run;
}

/// e' P^-1 e of a block of the errors.
double nees(const Look& look, int from, int size) {
  const Eigen::MatrixXd P = look.covariance.block(from, from, size, size);
  const Eigen::VectorXd e = look.error.segment(from, size);
  return e.dot(P.llt().solve(e));
}

void PrintTo(const Unit& unit, std::ostream* out) {
  *out << unit.name;
}

class Consistency : public ::testing::TestWithParam<Unit> {};

TEST_P(Consistency, ErrorsAreAsLargeAsTheCovarianceSays) {
  std::array<std::array<double, 6>, kLooks> sums{};  // all, and the five blocks
  double nis = 0.0;
  std::int64_t fixes = 0;
  for (int seed = 0; seed < kRuns; ++seed) {
    const Flight run = run_once(GetParam(), seed);
    nis += run.nis_sum;
    fixes += run.fixes;
    for (int k = 0; k < kLooks; ++k) {
      sums[k][0] += nees(run.looks[k], 0, I::kCount);
      for (int block = 0; block < 5; ++block) {
        sums[k][1 + block] += nees(run.looks[k], 3 * block, 3);
      }
    }
  }
  // Chi-square of 15 and 3 degrees, 50 runs: bounds of 99.9 % at each look.
  const double all_band = 3.29 * std::sqrt(2.0 * 15 / kRuns),
               block_band = 3.29 * std::sqrt(2.0 * 3 / kRuns);
  for (int k = 0; k < kLooks; ++k) {
    EXPECT_NEAR(sums[k][0] / kRuns, 15.0, all_band) << 10 * (k + 1) << " s";
    for (int block = 1; block < 6; ++block) {
      EXPECT_NEAR(sums[k][block] / kRuns, 3.0, block_band)
          << "block " << block << ", " << 10 * (k + 1) << " s";
    }
  }
  // Innovations are white: 50 * 300 fixes of three numbers.
  const double n = static_cast<double>(fixes);
  EXPECT_NEAR(nis / n, 3.0, 3.29 * std::sqrt(2.0 * 3 / n));
  RecordProperty("nees_60s", std::to_string(sums[kLooks - 1][0] / kRuns));
  RecordProperty("nis", std::to_string(nis / n));
}

TEST_P(Consistency, TellsAFilterThatIsWrongAboutItsFixes) {
  // If only half the fixes' standard deviation is stated, the bounds must reject the filter.
  double sum = 0.0;
  for (int seed = 0; seed < 10; ++seed) {
    sum += nees(run_once(GetParam(), seed, 0.25).looks[kLooks - 1], 0, 6);
  }
  EXPECT_GT(sum / 10, 6.0 + 1.96 * std::sqrt(2.0 * 6 / 10));
}

TEST_P(Consistency, HalfAndTwiceTheNoiseThatItIsTold) {
  // Rms of the position and mean NEES of position, velocity and attitude at 60 s: the table of
  // docs/papers/localisation.md.
  const auto judge = [&](NoiseShare share) {
    double nees_sum = 0.0, squares = 0.0;
    for (int seed = 0; seed < kRuns; ++seed) {
      const Look look = run_once(GetParam(), seed, 1.0, share).looks[kLooks - 1];
      nees_sum += nees(look, 0, 9);
      squares += look.error.head<3>().squaredNorm();
    }
    const std::pair result(std::sqrt(squares / kRuns), nees_sum / kRuns);
    std::printf("%s fixes x %.1f, imu x %.1f: %.3f m, NEES %.1f of 9\n", GetParam().name.c_str(),
                share.fixes, share.imu, result.first, result.second);
    return result;
  };
  const auto nominal = judge({});
  for (const NoiseShare less : {NoiseShare{0.5, 1.0}, {1.0, 0.5}, {0.5, 0.5}}) {
    const auto [rms_m, mean_nees] = judge(less);
    EXPECT_LE(rms_m, 1.1 * nominal.first);
    EXPECT_LE(mean_nees, 1.1 * nominal.second);
    EXPECT_GE(mean_nees, 0.25 * 0.75 * nominal.second);  // a quarter where all its noise is half
  }
  for (const NoiseShare more : {NoiseShare{2.0, 1.0}, {1.0, 2.0}, {2.0, 2.0}}) {
    const auto [rms_m, mean_nees] = judge(more);
    EXPECT_LE(rms_m, 2.2 * nominal.first);
    EXPECT_LE(mean_nees, 4.0 * 1.25 * nominal.second);  // four times where all its noise is twice
    EXPECT_GE(mean_nees, 0.9 * nominal.second);
  }
}

TEST_P(Consistency, FindsTheBiases) {
  double gyro = 0.0, accel = 0.0;
  for (int seed = 0; seed < 10; ++seed) {
    const Look look = run_once(GetParam(), 100 + seed).looks[kLooks - 1];
    gyro += look.error.segment<3>(I::kGyroBias).squaredNorm() / 30.0;
    accel += look.error.segment<3>(I::kAccelBias).squaredNorm() / 30.0;
    EXPECT_GT(look.covariance.diagonal().minCoeff(), 0.0);
  }
  EXPECT_LT(std::sqrt(gyro), 0.3 * GetParam().gyro_bias_radps);
  EXPECT_LT(std::sqrt(accel), 0.5 * GetParam().accel_bias_mps2);
}

INSTANTIATE_TEST_SUITE_P(Units, Consistency, ::testing::Values(vn200(), mti10()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace vinerow::test::error_state_consistency_test
