#include "controllers/estimation/row_localisation/position_kalman.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <optional>

#include "controllers/estimation/row_localisation/echo_slab.h"
#include "controllers/estimation/row_localisation/integrity_set.h"
#include "engine/core/random.h"
#include "engine/math/pose.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::position_kalman_test {
namespace {

using Eigen::Matrix2d, Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

constexpr Time at_ms(std::int64_t ms) {
  return Time{ms * 1'000'000};
}

Matrix3d diagonal(double x, double y, double z) {
  return Vector3d(x, y, z).asDiagonal();
}

TEST(PositionKalman, AgreesWithTheTextbookMatrices) {
  // Eq. 19-22 of paper C with full 6 x 6 matrices, vectors instead of scalars.
  controllers::PositionKalmanParams params;
  params.walk_m2_per_s = 0.02;
  controllers::PositionKalman filter(params);
  RandomStream random(1, "test", "kalman");
  Vector3d p(1, 2, 3);
  Eigen::Matrix<double, 6, 1> x;
  x << p, Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> P = Eigen::Matrix<double, 6, 6>::Zero();
  P.diagonal() << 0.1, 0.2, 0.3, Vector3d::Constant(0.0025);
  ASSERT_TRUE(filter.start(Time{}, p, diagonal(0.1, 0.2, 0.3)));
  for (int i = 1; i <= 200; ++i) {
    const Vector3d v(random.normal(), random.normal(), random.normal());
    filter.predict(at_ms(10 * i), v);
    const double dt = 0.01, keep = std::exp(-dt / 5.0);
    Eigen::Matrix<double, 6, 6> F = Eigen::Matrix<double, 6, 6>::Identity();
    F.topRightCorner<3, 3>().diagonal().setConstant(dt);
    F.bottomRightCorner<3, 3>() *= keep;
    Eigen::Matrix<double, 6, 6> Q = Eigen::Matrix<double, 6, 6>::Zero();
    Q.diagonal() << Vector3d::Constant(0.02 * dt), Vector3d::Constant(0.0025 * (1.0 - keep * keep));
    x = F * x;
    x.head<3>() += dt * v;
    P = F * P * F.transpose() + Q;
    if (i % 20 == 0) {
      const Vector3d z(random.normal(), random.normal(), random.normal());
      const double age = 0.03;
      Eigen::Matrix<double, 3, 6> H;
      H << Matrix3d::Identity(), -age * Matrix3d::Identity();
      const Matrix3d R = diagonal(1.0, 1.0, 2.25);
      const Matrix3d S = H * P * H.transpose() + R;
      const Eigen::Matrix<double, 6, 3> K = P * H.transpose() * S.inverse();
      const Vector3d innovation = z - H * x;
      EXPECT_EQ(filter.correct_position(innovation, R.diagonal(), age, 0.0),
                controllers::DatumStatus::kAccepted);
      EXPECT_NEAR(filter.last_nis(), innovation.dot(S.inverse() * innovation) / 3.0, 1e-9);
      x += K * innovation;
      P = (Eigen::Matrix<double, 6, 6>::Identity() - K * H) * P;
    }
    ASSERT_LT((filter.x() - x).norm(), 1e-9);
    ASSERT_LT((filter.covariance() - P).norm(), 1e-9);
  }
}

TEST(PositionKalman, PredictsTheErrorOfItsVelocityInput) {
  // Variance of the way under a Gauss-Markov velocity error: 2 s^2 tau^2 (t/tau - 1 + exp(-t/tau)).
  controllers::PositionKalmanParams params;
  params.walk_m2_per_s = 0.0;
  controllers::PositionKalman filter(params);
  filter.start(Time{}, Vector3d::Zero(), diagonal(1e-6, 1e-6, 1e-6));
  for (int i = 1; i <= 2000; ++i) filter.predict(at_ms(10 * i), {1, 0, 0});
  const double ratio = 20.0 / 5.0;
  const double wanted = 2.0 * 0.0025 * 25.0 * (ratio - 1.0 + std::exp(-ratio));
  EXPECT_NEAR(filter.position_covariance()(0, 0) - 1e-6, wanted, 0.003 * wanted);  // steps of 10 ms
  EXPECT_NEAR(filter.p_W().x(), 20.0, 1e-9);
}

TEST(PositionKalman, ReplacingByItselfChangesNothingAndCarriesTheRestAlong) {
  controllers::PositionKalman filter{controllers::PositionKalmanParams{}};
  Matrix3d P = diagonal(0.3, 0.2, 0.4);
  P(0, 2) = P(2, 0) = 0.15;
  filter.start(Time{}, {1, 2, 3}, P);
  filter.predict(at_ms(100), {1, 0, 0});
  const auto before = filter.covariance();
  const Vector3d p = filter.p_W();
  filter.replace_horizontal(p.head<2>(), before.topLeftCorner<2, 2>());
  EXPECT_LT((filter.covariance() - before).norm(), 1e-14);
  // Height is correlated with east by 0.15 / 0.3.
  filter.replace_horizontal(p.head<2>() + Vector2d(0.1, 0.0), before.topLeftCorner<2, 2>());
  EXPECT_NEAR(filter.p_W().z() - p.z(), 0.1 * before(2, 0) / before(0, 0), 1e-12);
}

TEST(PositionKalman, RefusesWhatItCannotUseAndStaysAsItWas) {
  controllers::PositionKalman filter{controllers::PositionKalmanParams{}};
  EXPECT_FALSE(filter.start(Time{}, {kNaN, 0, 0}, diagonal(1, 1, 1)));
  EXPECT_FALSE(filter.start(Time{}, {0, 0, 0}, diagonal(1, -1, 1)));
  ASSERT_TRUE(filter.start(at_ms(100), {0, 0, 0}, diagonal(1, 1, 1)));
  const auto x = filter.x();
  const auto P = filter.covariance();
  EXPECT_EQ(filter.predict(at_ms(50), {1, 0, 0}), controllers::DatumStatus::kBackwards);
  EXPECT_EQ(filter.predict(at_ms(110), {1, kNaN, 0}), controllers::DatumStatus::kBadNumber);
  controllers::PositionKalman::Scalar datum;
  datum.gradient = controllers::PositionKalman::gradient_of({1, 0, 0}, 0.0);
  datum.innovation = kNaN;
  EXPECT_EQ(filter.correct(datum), controllers::DatumStatus::kBadNumber);
  datum.innovation = 0.5;
  datum.variance = 0.0;
  EXPECT_EQ(filter.correct(datum), controllers::DatumStatus::kBadNumber);
  datum.variance = 1.0;
  datum.innovation = 6.0;  // 6 / sqrt(2) = 4.2 sigma
  datum.gate_sigma = 4.0;
  EXPECT_EQ(filter.correct(datum), controllers::DatumStatus::kGated);
  EXPECT_EQ(filter.correct_position({1, 2, kNaN}, {1, 1, 1}, 0.0, 0.0),
            controllers::DatumStatus::kBadNumber);
  EXPECT_EQ(filter.correct_position({1, 2, 3}, {1, -1, 1}, 0.0, 0.0),
            controllers::DatumStatus::kBadNumber);
  Matrix2d indefinite;
  indefinite << 1, 2, 2, 1;
  EXPECT_EQ(filter.correct_horizontal({0, 0}, indefinite), controllers::DatumStatus::kNotPositive);
  EXPECT_EQ(filter.replace_horizontal({0, 0}, indefinite), controllers::DatumStatus::kNotPositive);
  EXPECT_EQ(filter.replace_horizontal({0, kNaN}, Matrix2d::Identity()),
            controllers::DatumStatus::kBadNumber);
  EXPECT_EQ(filter.x(), x);
  EXPECT_EQ(filter.covariance(), P);
  datum.gate_sigma = 5.0;
  EXPECT_EQ(filter.correct(datum), controllers::DatumStatus::kAccepted);
}

TEST(PositionKalman, StaysPositiveOverExtremeData) {
  RandomStream random(2, "test", "extreme");
  controllers::PositionKalman filter{controllers::PositionKalmanParams{}};
  filter.start(Time{}, Vector3d::Zero(), diagonal(1e4, 1e4, 1e4));
  for (int i = 1; i <= 20000; ++i) {
    if (i % 10 == 0) filter.predict(at_ms(i), {1, 0, 0});
    controllers::PositionKalman::Scalar datum;
    datum.gradient = controllers::PositionKalman::gradient_of(
        Vector3d(random.normal(), random.normal(), random.normal()).normalized(), 0.0);
    datum.innovation = 0.01 * random.normal();
    datum.variance = std::pow(10.0, random.uniform(-14.0, 6.0));
    filter.correct(datum);
    ASSERT_TRUE(filter.x().allFinite());
    ASSERT_EQ(filter.covariance(), filter.covariance().transpose());
    ASSERT_EQ(Eigen::LLT<Matrix3d>(filter.position_covariance()).info(), Eigen::Success);
  }
}

TEST(PositionKalman, HuberWeighsAnOutlierLikeOneAtTheBound) {
  // Far beyond the bound the pull is that of an innovation of huber sigma, whatever it is.
  double pulls[2];
  for (int i = 0; i < 2; ++i) {
    controllers::PositionKalman filter{controllers::PositionKalmanParams{}};
    filter.start(Time{}, Vector3d::Zero(), diagonal(1, 1, 1));
    controllers::PositionKalman::Scalar datum;
    datum.gradient = controllers::PositionKalman::gradient_of({1, 0, 0}, 0.0);
    datum.variance = 3.0;  // innovation's deviation: 2
    datum.huber_sigma = 1.5;
    datum.innovation = i == 0 ? 10.0 : 1000.0;
    filter.correct(datum);
    pulls[i] = filter.p_W().x();
  }
  EXPECT_NEAR(pulls[0], 0.25 * 1.5 * 2.0, 1e-12);
  EXPECT_NEAR(pulls[1], pulls[0], 1e-12);
}

/// What a sensor reads of a wall, and how an estimate with another position and heading sees it.
struct Echo {
  controllers::RangePrediction predicted;
  Vector3d p_W, p_estimated_W;
  double range_m = 0.0;
};

/// @returns nothing where the wall is not in sight
std::optional<Echo> draw_echo(RandomStream& random, const controllers::EchoBounds& bounds) {
  Echo echo;
  const double azimuth = random.uniform(-3.14159, 3.14159), rise = random.uniform(-0.3, 0.3);
  const Vector3d N(std::cos(azimuth) * std::cos(rise), std::sin(azimuth) * std::cos(rise),
                   std::sin(rise));
  echo.p_W = {random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-2, 2)};
  const double D = N.dot(echo.p_W) - random.uniform(0.5, 3.0);
  // At its bound every third time.
  const auto error = [&] {
    const double e = random.uniform(-1, 1);
    return random.uniform() < 0.33 ? std::copysign(1.0, e) : e;
  };
  const Vector3d lever(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0.05);
  const double yaw = random.uniform(-3.14159, 3.14159);
  const RollPitchYaw rpy = {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), yaw};
  const double bearing = random.uniform(-3.14159, 3.14159);
  const Vector3d u_B(std::cos(bearing), std::sin(bearing), 0.0);
  const auto q = quaternion_from_rpy(rpy);
  const auto q_estimated =
      quaternion_from_rpy({rpy.roll_rad, rpy.pitch_rad, yaw + bounds.yaw_rad * error()});
  if (N.dot(q * u_B) > -0.1 || N.dot(q_estimated * u_B) > -0.1) return std::nullopt;
  const double true_range =
      (D + bounds.map_m * error() - N.dot(echo.p_W + q * lever)) / N.dot(q * u_B);
  if (true_range < 0.02 || true_range > 4.0) return std::nullopt;
  echo.range_m = true_range + bounds.reading_m * error();
  echo.p_estimated_W = echo.p_W + Vector3d(random.normal(), random.normal(), random.normal());
  echo.predicted.origin_W = echo.p_estimated_W + q_estimated * lever;
  echo.predicted.dir_W = q_estimated * u_B;
  echo.predicted.hit.normal_W = N;
  echo.predicted.hit.plane_m = D;
  return echo;
}

TEST(EchoSlab, ContainsTheTruthUnderBoundedErrors) {
  RandomStream random(4, "test", "slab");
  const controllers::EchoBounds bounds{0.003, 0.09, 3.0 * 0.0035};
  int count = 0, tight = 0;
  for (int i = 0; i < 200'000; ++i) {
    const auto echo = draw_echo(random, bounds);
    if (!echo) continue;
    ++count;
    const controllers::EchoSlab slab =
        controllers::echo_slab(echo->predicted, echo->p_estimated_W, echo->range_m, bounds);
    const double at = slab.normal_W.dot(echo->p_W);
    ASSERT_GE(at, slab.lower_m - 1e-12);
    ASSERT_LE(at, slab.upper_m + 1e-12);
    tight += std::abs(at - 0.5 * (slab.lower_m + slab.upper_m)) > 0.9 * slab.half_width_m();
    // In the plane, with the height known to 5 cm.
    const double height_error = random.uniform(-0.05, 0.05);
    const controllers::EchoSlab2 flat =
        controllers::horizontal_slab(slab, echo->p_W.z() + height_error, 0.05);
    ASSERT_GE(flat.a.dot(echo->p_W.head<2>()), flat.lower_m - 1e-12);
    ASSERT_LE(flat.a.dot(echo->p_W.head<2>()), flat.upper_m + 1e-12);
  }
  EXPECT_GT(count, 20'000);
  EXPECT_GT(tight, count / 100);  // and it is not merely wide
}

TEST(EchoSlab, TheOtherSideOfTheWallMissesTheTruth) {
  // Paper C's eq. 10-12 take the side from an arctan, which loses it: the offset to the other side
  // of the line puts the slab 2 d |N'u| away.
  RandomStream random(6, "test", "side");
  const controllers::EchoBounds bounds{0.003, 0.09, 0.0};
  int count = 0;
  for (int i = 0; i < 10'000; ++i) {
    auto echo = draw_echo(random, bounds);
    if (!echo || echo->range_m * std::abs(echo->predicted.slope()) < 0.3) continue;
    ++count;
    echo->predicted.dir_W = -echo->predicted.dir_W;
    const controllers::EchoSlab slab =
        controllers::echo_slab(echo->predicted, echo->p_estimated_W, echo->range_m, bounds);
    const double at = slab.normal_W.dot(echo->p_W);
    ASSERT_TRUE(at < slab.lower_m || at > slab.upper_m);
  }
  EXPECT_GT(count, 500);
}

TEST(IntegritySet, GrowsByWhatItMayHaveMovedAndIsCutByEchoes) {
  // A vehicle that deviates from its predicted motion by at most `growth` each step stays inside.
  RandomStream random(8, "test", "set");
  controllers::IntegritySet set;
  EXPECT_FALSE(set.has_started());
  set.start(Vector3d::Zero(), diagonal(0.5, 0.5, 0.5));
  Vector3d p(0.2, -0.3, 0.1);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d displacement(0.015, 0.0, 0.0);
    const Vector3d off = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    p += displacement + 0.0015 * off;
    set.predict(displacement, 0.0015);
    ASSERT_TRUE(set.contains(p)) << i;
    const Vector3d N = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const double error = random.uniform(-0.1, 0.1);
    const controllers::CutStatus status =
        set.cut({N, N.dot(p) + error - 0.1, N.dot(p) + error + 0.1});
    ASSERT_NE(status, controllers::CutStatus::kEmpty);
    ASSERT_TRUE(set.contains(p)) << i;
  }
  EXPECT_LT(set.shape_m2().trace(), 0.5);
  const Vector3d centre = set.centre_W();
  EXPECT_EQ(set.cut({Vector3d::UnitX(), 900.0, 901.0}), controllers::CutStatus::kEmpty);
  EXPECT_EQ(set.centre_W(), centre);
}

TEST(PositionKalman, AllocatesNothing) {
  controllers::PositionKalman filter{controllers::PositionKalmanParams{}};
  filter.start(Time{}, Vector3d::Zero(), diagonal(1, 1, 1));
  std::size_t allocations = 0;
  {
    AllocationCounter counter;
    for (int i = 1; i < 100; ++i) {
      filter.predict(at_ms(10 * i), {1, 0, 0});
      filter.correct_position({0.1, 0.1, 0.1}, {1, 1, 1}, 0.0, 5.0);
      filter.correct_horizontal(filter.p_W().head<2>(), Matrix2d::Identity());
      filter.replace_horizontal(filter.p_W().head<2>(), 0.1 * Matrix2d::Identity());
    }
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
}

}  // namespace
}  // namespace vinerow::test::position_kalman_test
