/// Tightening of a small flying wing's tube MPC in gusts: figures of a prototype in other code.
/// Models: 12 m/s, sampled at 0.05 s. The matrices are printed to four decimals, the prototype had
/// them in full: putting random digits in place of those rounded off moves the half widths by up to
/// 2 % (altitude) and 1 % (others), and the prototype's lie within; ours are within 0.3 %.

#include <gtest/gtest.h>

#include "controllers/parts/solvers/invariant_set.h"
#include "controllers/parts/solvers/series_support.h"
#include "controllers/parts/solvers/zonotope.h"
#include "engine/core/random.h"
#include "tests/controllers/parts/aircraft/wing_models.h"
#include "tests/controllers/parts/solvers/invariance.h"

namespace vinerow::test::fixed_wing_sets_test {
namespace {

Eigen::VectorXd supports(const controllers::Support& S, const Eigen::MatrixXd& rows) {
  Eigen::VectorXd values(rows.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) values[i] = S(rows.row(i));
  return values;
}

/// How many m/s of gust the limits leave room for.
double largest_gust(const controllers::Support& S, const Wing& wing) {
  const Eigen::VectorXd x = supports(S, Eigen::MatrixXd::Identity(5, 5));
  return std::min(wing.state_limit.cwiseQuotient(x).minCoeff(),
                  wing.input_limit.cwiseQuotient(supports(S, wing.K)).minCoeff());
}

void expect_within(const Eigen::VectorXd& values, const Eigen::VectorXd& expected,
                   double relative) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i], expected[i], relative * expected[i]) << "entry " << i;
  }
}

TEST(FixedWingSets, HalfWidthsOfTheTubeAreThePrototypes) {
  const Wing lon = longitudinal_wing(), lat = lateral_wing();
  const Result<controllers::SeriesSupport> S_lon =
      controllers::SeriesSupport::make(lon.closed(), controllers::Zonotope(lon.E));
  const Result<controllers::SeriesSupport> S_lat =
      controllers::SeriesSupport::make(lat.closed(), controllers::Zonotope(lat.E));
  ASSERT_TRUE(S_lon && S_lat);
  const Eigen::MatrixXd axes = Eigen::MatrixXd::Identity(5, 5);
  Eigen::VectorXd x_lon(5), x_lat(5);
  x_lon << .684, 1.438, 1.048, .1387, 1.893;
  x_lat << 1.997, 2.117, .592, .2915, .1203;
  expect_within(supports(*S_lon, axes), x_lon, 3e-3);
  expect_within(supports(*S_lon, lon.K), Eigen::Vector2d(.1030, .0696), 3e-3);
  expect_within(supports(*S_lat, axes), x_lat, 3e-3);
  expect_within(supports(*S_lat, lat.K), Eigen::VectorXd::Constant(1, .1172), 3e-3);
  EXPECT_NEAR(largest_gust(*S_lon, lon), 2.09, 0.01);
  EXPECT_NEAR(largest_gust(*S_lat, lat), 1.79, 0.005);
  EXPECT_NEAR(largest_gust(*S_lon, lon.with_tight_limits()), 1.25, 0.005);
  EXPECT_NEAR(largest_gust(*S_lat, lat.with_tight_limits()), .745, 0.001);
}

TEST(FixedWingSets, AdversaryReachesTheHalfWidthsAndChanceDoesNot) {
  // Simulated: 600 gusts of +-1 m/s with the signs that push one output most.
  for (const Wing& wing : {longitudinal_wing(), lateral_wing()}) {
    const Eigen::MatrixXd A = wing.closed();
    const Result<controllers::SeriesSupport> S =
        controllers::SeriesSupport::make(A, controllers::Zonotope(wing.E));
    ASSERT_TRUE(S);
    Eigen::MatrixXd rows(5 + wing.K.rows(), 5);
    rows << Eigen::MatrixXd::Identity(5, 5), wing.K;
    RandomStream random(1, "", "gust");
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      constexpr int kSteps = 600;
      Eigen::MatrixXd reach(5, kSteps);
      reach.col(kSteps - 1) = rows.row(i);
      for (int k = kSteps - 1; k > 0; --k) reach.col(k - 1) = A.transpose() * reach.col(k);
      Eigen::VectorXd worst = Eigen::VectorXd::Zero(5), chance = worst;
      for (int k = 0; k < kSteps; ++k) {
        const Eigen::VectorXd push = wing.E.transpose() * reach.col(k);
        worst = A * worst + wing.E * push.cwiseSign();
        Eigen::VectorXd gust(wing.E.cols());
        for (double& d : gust) d = random.uniform() < 0.5 ? -1.0 : 1.0;
        chance = A * chance + wing.E * gust;
      }
      const double limit = (*S)(rows.row(i));
      EXPECT_NEAR(rows.row(i).dot(worst) / limit, 1.0, 1e-5);
      EXPECT_LT(std::abs(rows.row(i).dot(chance)), 0.95 * limit);
    }
  }
}

TEST(FixedWingSets, BoxAroundTheGustsIsSeveralTimesAsLarge) {
  struct Case {
    Wing wing;
    double gust, tight_gust;
  };
  double min_growth = 1e9, max_growth = 0.0;
  for (const Case& expected :
       {Case{longitudinal_wing(), .55, .27}, Case{lateral_wing(), .52, .22}}) {
    const Wing& wing = expected.wing;
    const Eigen::VectorXd half = controllers::Zonotope(wing.E).half_widths();
    const Result<controllers::SeriesSupport> S =
        controllers::SeriesSupport::make(wing.closed(), controllers::Zonotope::box(half));
    ASSERT_TRUE(S);
    EXPECT_NEAR(largest_gust(*S, wing), expected.gust, 0.006);
    EXPECT_NEAR(largest_gust(*S, wing.with_tight_limits()), expected.tight_gust, 0.005);
    const Result<controllers::SeriesSupport> exact =
        controllers::SeriesSupport::make(wing.closed(), controllers::Zonotope(wing.E));
    ASSERT_TRUE(exact);
    Eigen::MatrixXd rows(5 + wing.K.rows(), 5);
    rows << Eigen::MatrixXd::Identity(5, 5), wing.K;
    const Eigen::VectorXd growth = supports(*S, rows).cwiseQuotient(supports(*exact, rows));
    min_growth = std::min(min_growth, growth.minCoeff());
    max_growth = std::max(max_growth, growth.maxCoeff());
  }
  EXPECT_NEAR(min_growth, 1.4, 0.05);
  EXPECT_NEAR(max_growth, 8.4, 0.1);
}

TEST(FixedWingSets, TerminalSetsNeedThePrototypesNumberOfSteps) {
  for (const auto& [wing, steps] :
       {std::pair{longitudinal_wing(), 13}, std::pair{lateral_wing(), 16}}) {
    const Eigen::MatrixXd A = wing.closed();
    const controllers::Zonotope W(wing.E);
    const Result<controllers::SeriesSupport> S = controllers::SeriesSupport::make(A, W);
    ASSERT_TRUE(S);
    const controllers::Polytope X = wing.constraints();
    const controllers::Polytope tightened(X.F(), X.g() - supports(*S, X.F()));
    const Result<controllers::InvariantSet> terminal =
        controllers::maximal_invariant_set(A, tightened);
    ASSERT_TRUE(terminal) << terminal.reason();
    EXPECT_EQ(terminal->steps, steps);
    EXPECT_LE(invariance_excess(A, terminal->set, controllers::Zonotope(Eigen::MatrixXd(5, 0))),
              1e-8);
    // What an error in S and a nominal state in the terminal set add up to stays in the limits, and
    // so is part of the maximal robust set.
    const Result<controllers::InvariantSet> robust =
        controllers::maximal_robust_invariant_set(A, X, W);
    ASSERT_TRUE(robust) << robust.reason();
    EXPECT_LE(invariance_excess(A, robust->set, W), 1e-8);
    const controllers::Polytope& R = robust->set;
    for (int i = 0; i < R.rows(); ++i) {
      EXPECT_LE(terminal->set.support(R.F().row(i)) + (*S)(R.F().row(i)), R.g()[i] * (1.0 + 1e-8));
    }
  }
}

TEST(FixedWingSets, RobustSetIsWhatRandomAndWorstGustsStayIn) {
  const Wing wing = lateral_wing();
  const Eigen::MatrixXd A = wing.closed();
  const controllers::Polytope X = wing.constraints();
  const Result<controllers::InvariantSet> robust =
      controllers::maximal_robust_invariant_set(A, X, controllers::Zonotope(wing.E));
  ASSERT_TRUE(robust);
  RandomStream random(2, "", "gust");
  int inside = 0, steps_outside = 0;
  while (inside < 300) {
    Eigen::VectorXd x(5);
    for (int j = 0; j < 5; ++j) x[j] = random.uniform(-1.0, 1.0) * wing.state_limit[j];
    if (!robust->set.contains(x)) continue;
    ++inside;
    for (int k = 0; k < 100; ++k) {
      x = A * x + wing.E * (random.uniform() < 0.5 ? -1.0 : 1.0);
      steps_outside += !robust->set.contains(x, 1e-9) || !X.contains(x, 1e-9);
    }
  }
  EXPECT_EQ(steps_outside, 0);
}

TEST(FixedWingSets, LateralGustBeyondTheLimitIsRefusedWithBothNumbers) {
  const Wing wing = lateral_wing().with_tight_limits();
  const Result<controllers::InvariantSet> set = controllers::maximal_robust_invariant_set(
      wing.closed(), wing.constraints(), controllers::Zonotope(wing.E));
  ASSERT_FALSE(set);
  EXPECT_EQ(set.reason(),
            "the disturbance is too large: alone it brings row 2 of the constraints to 2.11866, "
            "the limit "
            "is 2.0944");
}

}  // namespace
}  // namespace vinerow::test::fixed_wing_sets_test
