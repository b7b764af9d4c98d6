/// Riccati and Lyapunov equations: closed forms, published gains, and problems without solution.
/// Random systems against scipy: optimal_control_scipy_check.py.

#include "controllers/parts/solvers/riccati.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace vinerow::test::riccati_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDegree = std::numbers::pi / 180.0;

MatrixXd scalar(double value) {
  return MatrixXd::Constant(1, 1, value);
}

TEST(Dare, ScalarClosedForm) {
  for (const double a : {0.3, -0.9, 1.0, 1.7}) {
    for (const double q : {1e-6, 0.5, 1e4}) {
      const double b = 0.7, r = 2.0;
      // b^2 p^2 + (r - a^2 r - b^2 q) p - q r = 0, the positive root
      const double half = 0.5 * (r - a * a * r - b * b * q);
      const double root = std::sqrt(half * half + b * b * q * r);
      const double p = half > 0.0 ? q * r / (half + root) : (root - half) / (b * b);
      const Result<MatrixXd> P =
          controllers::solve_dare(scalar(a), scalar(b), scalar(q), scalar(r));
      ASSERT_TRUE(P) << P.reason();
      EXPECT_NEAR((*P)(0, 0) / p, 1.0, 1e-12) << a << ' ' << q;
      EXPECT_NEAR(controllers::lqr_gain(scalar(a), scalar(b), scalar(r), *P)(0, 0),
                  a * b * p / (r + b * b * p), 1e-12);
    }
  }
}

TEST(Dare, DeadbeatWhereInputsCostNextToNothing) {
  // With R -> 0 and an invertible B the state is zero after one step and P = Q.
  MatrixXd A(2, 2), Q(2, 2);
  A << 1.2, 0.3, -0.4, 0.8;
  Q << 2.0, 0.5, 0.5, 1.0;
  const MatrixXd B = MatrixXd::Identity(2, 2), R = 1e-13 * B;
  const Result<MatrixXd> P = controllers::solve_dare(A, B, Q, R);
  ASSERT_TRUE(P) << P.reason();
  EXPECT_LT((*P - Q).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((controllers::lqr_gain(A, B, R, *P) - A).cwiseAbs().maxCoeff(), 1e-12);
}

struct Wing {
  MatrixXd A, B, Q, R;
  MatrixXd K;          // u = K x as published, worked out from more digits of A and B
  MatrixXd K_rounded;  // by scipy's solve_discrete_are() from the digits here
  double radius;
};

/// Fixed wing at 12 m/s sampled at 20 Hz: u, w, q, theta, h; throttle and elevator.
Wing longitudinal() {
  Wing wing{MatrixXd(5, 5), MatrixXd(5, 2), MatrixXd(5, 5), MatrixXd(2, 2),
            MatrixXd(2, 5), MatrixXd(2, 5), 0.9764};
  wing.A << 0.9739, 0.0496, -0.0649, -0.4818, 0, -0.0215, 0.6433, 0.3848, -0.0451, 0, 0.0614,
      -0.3532, 0.6485, -0.0027, 0, 0.0016, -0.0100, 0.0416, 1, 0, 0.0073, -0.0431, 0.0023, 0.5997,
      1;
  wing.B << 0.5764, 0.2057, -0.0082, -2.0268, 0.0183, -5.0291, 0.0003, -0.1361, 0.0021, 0.0138;
  VectorXd largest(5);
  largest << 0.6, 1.0, 60 * kDegree, 6 * kDegree, 2.0;
  wing.Q = largest.cwiseAbs2().cwiseInverse().asDiagonal();
  wing.R = Eigen::Vector2d(1 / (0.1 * 0.1), 1 / std::pow(4 * kDegree, 2)).asDiagonal();
  wing.K << -0.1192, -0.0085, 0.0047, -0.0048, -0.0243, -0.0101, -0.0418, 0.0597, 0.7366, 0.0246;
  wing.K_rounded << -0.11929, -0.00851, 0.00474, -0.00541, -0.02430, -0.01007, -0.04173, 0.05968,
      0.73652, 0.02462;
  return wing;
}

/// v, p, r, phi, psi; aileron.
Wing lateral() {
  Wing wing{MatrixXd(5, 5), MatrixXd(5, 1), MatrixXd(5, 5), MatrixXd(1, 1),
            MatrixXd(1, 5), MatrixXd(1, 5), 0.9463};
  wing.A << 0.9398, 0.0756, -0.5548, 0.4745, 0, -0.4098, 0.5872, 0.2817, -0.1097, 0, 0.0564,
      -0.0325, 0.9531, 0.0132, 0, -0.0111, 0.0389, 0.0127, 0.9981, 0, 0.0014, -0.0009, 0.0494,
      0.0002, 1;
  wing.B << 0.2902, 5.2140, -0.2609, 0.1413, -0.0057;
  VectorXd largest(5);
  largest << 1.5, 90 * kDegree, 60 * kDegree, 12 * kDegree, 8 * kDegree;
  wing.Q = largest.cwiseAbs2().cwiseInverse().asDiagonal();
  wing.R = scalar(1 / std::pow(4 * kDegree, 2));
  wing.K << -0.0290, -0.0429, -0.1258, -0.5042, -0.4278;
  wing.K_rounded << -0.02901, -0.04289, -0.12533, -0.50381, -0.42777;
  return wing;
}

void expect_published_gain(const Wing& wing) {
  const Result<MatrixXd> P = controllers::solve_dare(wing.A, wing.B, wing.Q, wing.R);
  ASSERT_TRUE(P) << P.reason();
  const MatrixXd K = -controllers::lqr_gain(wing.A, wing.B, wing.R, *P);
  EXPECT_LT((K - wing.K_rounded).cwiseAbs().maxCoeff(), 6e-6) << K;
  EXPECT_LT((K - wing.K).cwiseAbs().maxCoeff(), 7e-4) << K;
  EXPECT_NEAR(controllers::spectral_radius(wing.A + wing.B * K), wing.radius, 5e-4);
  EXPECT_EQ(*P, P->transpose());
  // The cost of the closed loop summed up by itself is P as well.
  const Result<MatrixXd> sum = controllers::solve_discrete_lyapunov(
      wing.A + wing.B * K, wing.Q + K.transpose() * wing.R * K);
  ASSERT_TRUE(sum) << sum.reason();
  EXPECT_LT((*sum - *P).norm(), 1e-11 * P->norm());
}

TEST(Dare, FixedWingLongitudinal) {
  expect_published_gain(longitudinal());
}
TEST(Dare, FixedWingLateral) {
  expect_published_gain(lateral());
}

TEST(Dare, SaysWhatCannotBeStabilised) {
  MatrixXd A(2, 2);
  A << 0.5, 1.0, 0.0, 1.25;
  const MatrixXd I = MatrixXd::Identity(2, 2);
  Result<MatrixXd> P = controllers::solve_dare(A, Eigen::Vector2d(1.0, 0.0), I, scalar(1.0));
  ASSERT_FALSE(P);
  EXPECT_EQ(P.reason(),
            "(A, B) cannot be stabilised: no input reaches the mode with eigenvalue 1.25");
  // The same mode can be left alone where it dies out by itself.
  A(1, 1) = 0.9;
  P = controllers::solve_dare(A, Eigen::Vector2d(1.0, 0.0), I, scalar(1.0));
  EXPECT_TRUE(P) << P.reason();
  // An integrator without an input, and an undamped oscillation.
  A(1, 1) = 1.0;
  P = controllers::solve_dare(A, Eigen::Vector2d(1.0, 0.0), I, scalar(1.0));
  ASSERT_FALSE(P);
  EXPECT_EQ(P.reason(), "(A, B) cannot be stabilised: no input reaches the mode with eigenvalue 1");
  MatrixXd turn = MatrixXd::Zero(3, 3);
  turn << 0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, 0.5;
  P = controllers::solve_dare(turn, Eigen::Vector3d(0.0, 0.0, 1.0), MatrixXd::Identity(3, 3),
                              scalar(1.0));
  ASSERT_FALSE(P);
  EXPECT_EQ(P.reason(),
            "(A, B) cannot be stabilised: no input reaches the mode with eigenvalues 0.6 +- 0.8i");
}

TEST(Dare, SaysWhatIsNotSeen) {
  const MatrixXd A = Eigen::Vector2d(0.5, 1.25).asDiagonal();
  const MatrixXd Q = Eigen::Vector2d(1.0, 0.0).asDiagonal();
  const Result<MatrixXd> P = controllers::solve_dare(A, Eigen::Vector2d(1.0, 1.0), Q, scalar(1.0));
  ASSERT_FALSE(P);
  EXPECT_EQ(P.reason(),
            "(A, Q) leaves an unstable mode unseen: Q gives no weight to the mode with eigenvalue "
            "1.25");
}

// The mode of eigenvalue 1 has a weight, small beside the other one.
TEST(Dare, WeightsOfVeryDifferentSizeAreSeen) {
  MatrixXd A(2, 2);
  A << 1.0, 1.0, 0.0, 1.0;
  const MatrixXd Q = Eigen::Vector2d(1.0, 1e40).asDiagonal();
  const Result<MatrixXd> P = controllers::solve_dare(A, Eigen::Vector2d(0.0, 1.0), Q, scalar(1.0));
  ASSERT_FALSE(P);
  EXPECT_EQ(P.reason(), "the Riccati equation of (A, B, Q, R) has no stabilising solution");
}

TEST(Dare, RefusesWeightsThatAreNone) {
  const MatrixXd one = scalar(1.0);
  EXPECT_EQ(controllers::solve_dare(one, one, one, scalar(0.0)).reason(),
            "R is not positive definite");
  EXPECT_EQ(controllers::solve_dare(one, one, one, scalar(-1.0)).reason(),
            "R is not positive definite");
  const MatrixXd nan = scalar(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(controllers::solve_dare(one, one, nan, one).reason(),
            "A, B, Q or R contains a number that is not finite");
}

TEST(Lyapunov, GeometricSeries) {
  for (const double a : {0.0, -0.5, 0.999999}) {
    const Result<MatrixXd> P = controllers::solve_discrete_lyapunov(scalar(a), scalar(3.0));
    ASSERT_TRUE(P) << P.reason();
    EXPECT_NEAR((*P)(0, 0) * (1.0 - a * a) / 3.0, 1.0, 1e-9);
  }
  // A nilpotent A of order 3: three terms
  MatrixXd A = MatrixXd::Zero(3, 3);
  A(0, 1) = 2.0;
  A(1, 2) = 3.0;
  const Result<MatrixXd> P = controllers::solve_discrete_lyapunov(A, MatrixXd::Identity(3, 3));
  ASSERT_TRUE(P) << P.reason();
  const MatrixXd expected = Eigen::Vector3d(1.0, 1.0 + 4.0, 1.0 + 9.0 * (1.0 + 4.0)).asDiagonal();
  EXPECT_LT((*P - expected).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Lyapunov, SaysHowUnstable) {
  const Result<MatrixXd> P = controllers::solve_discrete_lyapunov(scalar(-1.02), scalar(1.0));
  ASSERT_FALSE(P);
  EXPECT_EQ(P.reason(), "A is not Schur stable: its spectral radius is 1.02");
  EXPECT_FALSE(controllers::solve_discrete_lyapunov(scalar(1.0), scalar(1.0)));
}

TEST(SpectralRadius, OfATurnAndOfNothing) {
  MatrixXd turn(2, 2);
  turn << 0.0, -0.9, 0.9, 0.0;
  EXPECT_NEAR(controllers::spectral_radius(turn), 0.9, 1e-15);
  EXPECT_EQ(controllers::spectral_radius(MatrixXd(0, 0)), 0.0);
  turn(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(controllers::spectral_radius(turn), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace vinerow::test::riccati_test
