// The metric `estimation` on signals made by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "engine/api/map.h"
#include "engine/api/messages/flight.h"
#include "engine/api/world_model.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "engine/metrics/batch_means.h"
#include "engine/metrics/estimate_judge.h"
#include "engine/metrics/estimation.h"
#include "tests/support/no_alloc.h"

namespace vinerow::metrics::estimation_metric_test {
namespace {

using Eigen::Vector3d;
using Results = std::map<std::string, double>;

class Bench {
 public:
  /// Rows along `azimuth_rad`, 2.5 m apart, 40 m long, about the origin.
  explicit Bench(double azimuth_rad = 0.0, double from_s = 0.0, VehicleDescription vehicle = {})
      : vehicle_(std::move(vehicle)) {
    const Eigen::Rotation2Dd R(azimuth_rad);
    for (const double across : {-1.25, 1.25}) {
      PlantRow row;
      for (const double along : {-20.0, 0.0, 20.0}) {
        const Eigen::Vector2d p = R * Eigen::Vector2d(along, across);
        row.line_W.push_back({p.x(), p.y(), 0.0});
      }
      world_.rows->rows.push_back(row);
    }
    Ports ports(bus_, "rover", "test");
    truth_ = ports.write<Odometry>("truth");
    estimate_ = ports.write<Odometry>("estimate");
    ellipsoid_ = ports.write<PositionEllipsoid>("ellipsoid");
    state_ = ports.write<NamedValues>("estimator_state");
    reference_ = ports.write<ReferenceTrajectory>("reference");
    MetricContext context;
    context.vehicle_description = &vehicle_;
    context.world = &world_;
    ParameterSet parameters(estimation_spec().parameters, "estimation");
    parameters.set("from_s", from_s);
    metric_ = make_estimation(parameters, context);
    Ports own(bus_, "rover", "rover.metrics.estimation");
    metric_->connect(own);
  }
  void write_truth(const Vector3d& p, double yaw_rad) {
    now_ = now_ + Duration{25'000'000};
    truth = {};
    truth.X_WB = {quaternion_from_rpy({0, 0, yaw_rad}), p};
    truth_.write(now_, truth);
  }
  void write_estimate(const Vector3d& error_W, double yaw_error_rad = 0.0,
                      const Eigen::Matrix3d& P = Eigen::Matrix3d::Identity(), Duration age = {}) {
    Odometry estimate = truth;
    estimate.X_WB.p += error_W;
    estimate.X_WB.q = quaternion_from_rpy({0, 0, yaw_error_rad}) * truth.X_WB.q;
    estimate.set_position_covariance(P);
    estimate_.write(now_ - age, estimate);
  }
  void write_ellipsoid(const PositionEllipsoid& value) { ellipsoid_.write(now_, value); }
  void write_state(const NamedValues& value) { state_.write(now_, value); }
  void write_phase(ReferenceTrajectory::Phase phase) {
    ReferenceTrajectory reference;
    reference.phase = phase;
    reference_.write(now_, reference);
  }
  void look() { metric_->step(now_); }
  Results results() const { return metric_->results(); }
  double result(const std::string& name) const { return metric_->results().at(name); }

  Odometry truth;

 private:
  VehicleDescription vehicle_;
  WorldModel world_;
  SignalBus bus_;
  Time now_;
  std::unique_ptr<Metric> metric_;
  SignalWriter<Odometry> truth_, estimate_;
  SignalWriter<PositionEllipsoid> ellipsoid_;
  SignalWriter<NamedValues> state_;
  SignalWriter<ReferenceTrajectory> reference_;
};

TEST(EstimationMetric, SplitsErrorsAlongAndAcrossTheRows) {
  for (const double azimuth : {0.0, -0.5, 2.0}) {
    for (const bool looks_back : {false, true}) {
      Bench bench(azimuth);
      const double yaw = azimuth + (looks_back ? kPi : 0.0);
      const Eigen::AngleAxisd R(yaw, Vector3d::UnitZ());
      // The heading wanders by 20 degrees; the direction is the row's.
      for (const double wander : {-0.35, 0.35}) {
        bench.write_truth(Vector3d(1, 0.2, 0.5), yaw + wander);
        bench.write_estimate(R * Vector3d(0.3, wander > 0 ? 0.1 : -0.05, -0.2), 0.02);
        bench.look();
      }
      EXPECT_NEAR(bench.result("estimate_longitudinal_rms_m"), 0.3, 1e-12);
      EXPECT_NEAR(bench.result("estimate_longitudinal_std_m"), 0.0, 1e-7);
      EXPECT_NEAR(bench.result("estimate_lateral_rms_m"), std::sqrt((0.01 + 0.0025) / 2), 1e-12);
      EXPECT_NEAR(bench.result("estimate_lateral_std_m"), 0.075, 1e-12);
      EXPECT_NEAR(bench.result("estimate_lateral_max_m"), 0.1, 1e-12);
      EXPECT_NEAR(bench.result("estimate_longitudinal_max_m"), 0.3, 1e-12);
      EXPECT_NEAR(bench.result("estimate_vertical_rms_m"), 0.2, 1e-12);
      EXPECT_NEAR(bench.result("estimate_yaw_rms_deg"), deg_from_rad(0.02), 1e-9);
    }
  }
}

TEST(EstimationMetric, TakesTheHeadingWhereNoRowIsNear) {
  Bench bench(0.0);
  bench.write_truth({0, 30, 0}, 0.5 * kPi);
  bench.write_estimate({0.4, 0.1, 0});
  bench.look();
  EXPECT_NEAR(bench.result("estimate_longitudinal_rms_m"), 0.1, 1e-12);
  EXPECT_NEAR(bench.result("estimate_lateral_rms_m"), 0.4, 1e-12);
}

TEST(EstimationMetric, JudgesByTheTurnedCovariance) {
  // Axes of 0.2 and 0.1 m, turned by 30 degrees: an error of two sigmas along the first and one
  // along the second has NEES 5 whatever the turn; 2.5 and 1 lie outside the 95 % ellipse.
  const Eigen::Matrix3d R = Eigen::AngleAxisd(kPi / 6, Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d P = R * Vector3d(0.04, 0.01, 1.0).asDiagonal() * R.transpose();
  Bench bench;
  bench.write_truth({0, 0, 0}, 0.0);
  bench.write_estimate(R * Vector3d(0.4, 0.1, 7), 0, P);
  bench.look();
  EXPECT_NEAR(bench.result("nees_mean"), 5.0, 1e-9);
  EXPECT_EQ(bench.result("nees_in_95_share"), 1.0);
  bench.write_truth({0, 0, 0}, 0.0);
  bench.write_estimate(R * Vector3d(0.5, 0.1, 0), 0, P);
  bench.look();
  EXPECT_NEAR(bench.result("nees_mean"), (5.0 + 7.25) / 2, 1e-9);
  EXPECT_EQ(bench.result("nees_in_95_share"), 0.5);
  EXPECT_TRUE(std::isnan(bench.result("estimate_consistent"))) << "two samples tell nothing";
  // An invalid covariance contains nothing and is never consistent.
  bench.write_truth({0, 0, 0}, 0.0);
  bench.write_estimate({0, 0, 0}, 0, Vector3d(-1, 1, 1).asDiagonal());
  bench.look();
  EXPECT_NEAR(bench.result("nees_in_95_share"), 1.0 / 3, 1e-12);
  EXPECT_EQ(bench.result("estimate_consistent"), 0.0);
}

/// Errors of 1 sigma with correlation exp(-1 / ticks), stated with `std_factor` times that sigma.
Bench run_noise(double ticks, double std_factor, int samples, int seed, double bias = 0.0) {
  Bench bench;
  RandomStream random(seed, "test", "noise");
  const double keep = ticks > 0.0 ? std::exp(-1.0 / ticks) : 0.0;
  Vector3d e(random.normal(), random.normal(), 0);
  for (int i = 0; i < samples; ++i) {
    const double a = random.normal(), b = random.normal();
    e = keep * e + std::sqrt(1 - keep * keep) * Vector3d(a, b, 0);
    bench.write_truth({0, 0, 0}, 0.0);
    bench.write_estimate(e + Vector3d(bias, 0, 0), 0,
                         std_factor * std_factor * Eigen::Matrix3d::Identity());
    bench.look();
  }
  return bench;
}

TEST(EstimationMetric, BelievesAFilterThatIsRightAndNoOther) {
  for (const double correlation : {0.0, 40.0}) {
    int right = 0, shy = 0, bold = 0, biased = 0;
    for (int seed = 0; seed < 20; ++seed) {
      right += run_noise(correlation, 1.0, 4000, seed).result("estimate_consistent") == 1.0;
      shy += run_noise(correlation, 1.6, 4000, seed).result("estimate_consistent") == 1.0;
      bold += run_noise(correlation, 0.6, 4000, seed).result("estimate_consistent") == 1.0;
      biased += run_noise(correlation, 1.0, 4000, seed, 1.5).result("estimate_consistent") == 1.0;
    }
    EXPECT_GE(right, 18) << correlation;
    EXPECT_LE(shy, 2) << correlation;
    EXPECT_LE(bold, 2) << correlation;
    EXPECT_LE(biased, 2) << correlation;
  }
  const Bench white = run_noise(0.0, 1.0, 20'000, 3);
  EXPECT_NEAR(white.result("nees_mean"), 2.0, 4 * 2.0 / std::sqrt(20'000));
  EXPECT_NEAR(white.result("nees_in_95_share"), 0.95, 4 * std::sqrt(0.95 * 0.05 / 20'000));
}

TEST(BatchMeans, CountIndependentSamplesOfAnAutoregression) {
  // x_k = a x_(k-1) + noise has an integrated autocorrelation of (1 + a) / (1 - a).
  for (const double a : {0.0, 0.8, 0.95}) {
    double mean_count = 0.0;
    const int n = 20'000, seeds = 20;
    for (int seed = 0; seed < seeds; ++seed) {
      RandomStream random(seed, "test", "ar");
      BatchMeans means;
      double x = random.normal() / std::sqrt(1 - a * a);
      for (int i = 0; i < n; ++i) {
        x = a * x + random.normal();
        means.add(x);
      }
      mean_count += means.independent_count() / seeds;
    }
    // The ratio of variances over 16 to 31 batches is wide: +-35 % (1 sigma) each, 20 seeds.
    EXPECT_NEAR(mean_count * (1 + a) / (1 - a) / n, 1.0, 0.35) << a;
  }
}

TEST(EstimationMetric, KnowsTheChiSquareDistribution) {
  // Quantiles of 2.5 % and 97.5 %: scipy.stats.chi2.ppf.
  const double z = 1.959963984540054;
  EXPECT_NEAR(chi_square_quantile(10, -z), 3.2470, 0.05);
  EXPECT_NEAR(chi_square_quantile(10, z), 20.4832, 0.05);
  EXPECT_NEAR(chi_square_quantile(100, -z), 74.2219, 0.05);
  EXPECT_NEAR(chi_square_quantile(100, z), 129.5612, 0.05);
}

TEST(EstimationMetric, MeasuresNothingWhereTheEstimateIsTheTruth) {
  Bench bench;
  for (int i = 0; i < 100; ++i) {
    bench.write_truth({0.1 * i, 0, 0}, 0.1);
    bench.write_estimate({0, 0, 0}, 0, Eigen::Matrix3d::Zero());
    bench.look();
  }
  for (const auto& [name, value] : bench.results()) EXPECT_TRUE(std::isnan(value)) << name;
  // The first difference makes an estimate of what came before as well.
  bench.write_truth({10, 0, 0}, 0.1);
  bench.write_estimate({0, 0.1, 0}, 0, Eigen::Matrix3d::Zero());
  bench.look();
  EXPECT_NEAR(bench.result("estimate_lateral_rms_m"), 0.1 / std::sqrt(101), 1e-12);
  EXPECT_TRUE(std::isnan(bench.result("nees_mean"))) << "it states no covariance";
  EXPECT_TRUE(std::isnan(bench.result("ellipsoid_containment_share")));
}

TEST(EstimationMetric, LeavesOutTheBeginningAndOldEstimates) {
  Bench bench(0.0, 1.0);
  bench.write_truth({0, 0, 0}, 0);  // 25 ms
  bench.write_estimate({9, 9, 9});
  bench.look();
  for (int i = 0; i < 40; ++i) bench.write_truth({0, 0, 0}, 0);
  bench.look();  // the estimate is a second old
  bench.write_estimate({5, 0, 0}, 0, Eigen::Matrix3d::Identity(), Duration{5'000'000});
  bench.look();
  EXPECT_TRUE(std::isnan(bench.result("estimate_longitudinal_rms_m")));
  bench.write_estimate({0.2, 0, 0});
  bench.look();
  EXPECT_NEAR(bench.result("estimate_longitudinal_max_m"), 0.2, 1e-12);
}

TEST(EstimationMetric, JudgesFirmwareThatReportsBetweenTicks) {
  // 15 ms after a tick, in the 25 ms in which the vehicle drives 1 m: it was at 0.6 m then.
  const auto drive = [](Bench& bench) {
    bench.write_truth({0, 0, 0}, 0);
    bench.look();
    bench.write_truth({1, 0, 0}, 0);
    bench.write_estimate({-0.3, 0, 0}, 0, Eigen::Matrix3d::Identity(), Duration{10'000'000});
    bench.look();
  };
  Bench firmware(0.0);
  drive(firmware);
  EXPECT_NEAR(firmware.result("estimate_longitudinal_max_m"), 0.1, 1e-12);
  // An estimator that begins at a tick is judged at ticks alone.
  Bench estimator(0.0);
  estimator.write_truth({0, 0, 0}, 0);
  estimator.write_estimate({0.02, 0, 0});
  estimator.look();
  drive(estimator);
  EXPECT_NEAR(estimator.result("estimate_longitudinal_max_m"), 0.02, 1e-12);
}

TEST(EstimationMetric, LeavesOutARotorcraftThatHasLanded) {
  using Phase = ReferenceTrajectory::Phase;
  const auto largest_m = [](const VehicleDescription& vehicle) {
    Bench bench(0.0, 0.0, vehicle);
    for (const auto& [phase, error_m] : {std::pair(Phase::kLand, 0.1), {Phase::kDone, 0.5}}) {
      bench.write_truth({0, 0, 0}, 0);
      bench.write_phase(phase);
      bench.write_estimate({error_m, 0, 0});
      bench.look();
    }
    return bench.result("estimate_longitudinal_max_m");
  };
  VehicleDescription rotors, wings;
  rotors.rotorcraft.emplace();
  wings.fixed_wing.emplace();
  EXPECT_NEAR(largest_m(rotors), 0.1, 1e-12);
  EXPECT_NEAR(largest_m(wings), 0.5, 1e-12) << "what has wings has no such reference";
}

TEST(EstimationMetric, CountsWhatTheEllipsoidContains) {
  Bench bench;
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Matrix3d P = R * Vector3d(0.04, 0.01, 0.09).asDiagonal() * R.transpose();
  PositionEllipsoid ellipsoid;
  ellipsoid.centre_W = {1, 2, 3};
  ellipsoid.shape_diagonal_m2 = P.diagonal();
  ellipsoid.shape_beside_m2 = {P(0, 1), P(0, 2), P(1, 2)};
  for (const double scale : {0.99, 1.01, -0.5, -1.5}) {
    bench.write_truth(ellipsoid.centre_W + R * Vector3d(0, 0.1 * scale, 0), 0);
    bench.write_estimate({0.1, 0, 0});
    bench.write_ellipsoid(ellipsoid);
    bench.look();
  }
  EXPECT_EQ(bench.result("ellipsoid_containment_share"), 0.5);
  // A flat one is judged in the plane.
  ellipsoid.shape_diagonal_m2 = {0.04, 0.01, 0};
  ellipsoid.shape_beside_m2.setZero();
  for (int i = 0; i < 4; ++i) {
    bench.write_truth({1.19, 2, 99}, 0);
    bench.write_ellipsoid(ellipsoid);
    bench.look();
  }
  EXPECT_EQ(bench.result("ellipsoid_containment_share"), 0.75);
}

TEST(EstimationMetric, AveragesTheNisOfNamedSourcesOnceEach) {
  Bench bench;
  NamedValues state;
  state.names = {"used_gnss_position", "nis_gnss_position", "nis_other"};
  for (const double nis : {0.0, 2.0, 2.0, 2.0, 5.0}) {
    state.values = {1, nis, 77};
    bench.write_truth({0, 0, 0}, 0);
    bench.write_estimate({0.1, 0, 0});
    bench.write_state(state);
    bench.look();
  }
  EXPECT_DOUBLE_EQ(bench.result("nis_gnss_position_mean"), 3.5);
  EXPECT_TRUE(std::isnan(bench.result("nis_barometer_mean")));
  EXPECT_FALSE(bench.results().contains("nis_other_mean"));
}

TEST(EstimationMetric, AllocatesNothing) {
  Bench bench;
  std::size_t allocations = 0;
  {
    test::AllocationCounter counter;
    for (int i = 0; i < 100; ++i) {
      bench.write_truth({0, 0, 0}, 0);
      bench.write_estimate({0.1, 0, 0});
      bench.look();
    }
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
}

}  // namespace
}  // namespace vinerow::metrics::estimation_metric_test
