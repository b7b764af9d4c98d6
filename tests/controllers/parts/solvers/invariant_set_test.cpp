#include "controllers/parts/solvers/invariant_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "controllers/parts/solvers/zonotope.h"
#include "tests/controllers/parts/solvers/invariance.h"
#include "tests/controllers/parts/solvers/random_sets.h"

namespace vinerow::test::invariant_set_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(InvariantSet, ScalarAndDiagonalSystemsKeepTheirWholeBox) {
  const controllers::Polytope line =
      controllers::Polytope::box(Eigen::VectorXd::Constant(1, -0.7), Eigen::VectorXd::Ones(1));
  const Result<controllers::InvariantSet> scalar =
      controllers::maximal_invariant_set(Eigen::MatrixXd::Constant(1, 1, 0.99), line);
  ASSERT_TRUE(scalar);
  EXPECT_EQ(scalar->steps, 0);
  EXPECT_TRUE(same_set(scalar->set, line));
  const controllers::Polytope box = controllers::Polytope::box(Eigen::Vector3d(1.0, 2.0, 3.0));
  const Eigen::Matrix3d A = Eigen::Vector3d(0.5, -0.8, 0.99).asDiagonal();
  const Result<controllers::InvariantSet> diagonal = controllers::maximal_invariant_set(A, box);
  ASSERT_TRUE(diagonal);
  EXPECT_EQ(diagonal->steps, 0);
  EXPECT_TRUE(same_set(diagonal->set, box));
  EXPECT_EQ(diagonal->set.rows(), 6);
}

TEST(InvariantSet, NegativeScalarMirrorsTheNearerLimit) {
  // x+ = -x / 2 in [-5, 1]: -5 would go to 2.5, so only [-2, 1] stays.
  const controllers::Polytope line =
      controllers::Polytope::box(Eigen::VectorXd::Constant(1, -5.0), Eigen::VectorXd::Ones(1));
  const Result<controllers::InvariantSet> set =
      controllers::maximal_invariant_set(Eigen::MatrixXd::Constant(1, 1, -0.5), line);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->steps, 1);
  EXPECT_TRUE(same_set(set->set, controllers::Polytope::box(Eigen::VectorXd::Constant(1, -2.0),
                                                            Eigen::VectorXd::Ones(1))));
}

TEST(InvariantSet, OneStepCutsTheSecondState) {
  // x+ = diag(1/2, 0) x, |x_1 + x_2| <= 1, unbounded: the next step asks |x_1| <= 2, later ones
  // less.
  const Eigen::Matrix2d A = Eigen::Vector2d(0.5, 0.0).asDiagonal();
  Eigen::MatrixXd rows(2, 2);
  rows << 1, 1, -1, -1;
  const controllers::Polytope strip(rows, Eigen::Vector2d(1.0, 1.0));
  const Result<controllers::InvariantSet> set = controllers::maximal_invariant_set(A, strip);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->steps, 1);
  EXPECT_TRUE(same_set(
      set->set, strip.intersection(controllers::Polytope::box(Eigen::Vector2d(2.0, kInfinity)))));
  EXPECT_EQ(set->set.rows(), 4);
}

TEST(InvariantSet, ContractedQuarterTurnSwapsTheLimits) {
  // After k quarter turns with r = 1/2 each limit holds for another half axis, 2^k times as wide.
  const double r = 0.5;
  Eigen::Matrix2d A;
  A << 0.0, -r, r, 0.0;
  const controllers::Polytope X =
      controllers::Polytope::box(Eigen::Vector2d(-8.0, -0.75), Eigen::Vector2d(1.0, 10.0));
  const Result<controllers::InvariantSet> set = controllers::maximal_invariant_set(A, X);
  ASSERT_TRUE(set);
  // One turn on: x_1 / 2 >= -0.75; two turns: -x_2 / 4 >= -0.75; three: x_2 / 8 <= 1, no more.
  const controllers::Polytope expected =
      controllers::Polytope::box(Eigen::Vector2d(-1.5, -0.75), Eigen::Vector2d(1.0, 3.0));
  EXPECT_TRUE(same_set(set->set, expected));
  EXPECT_EQ(set->steps, 2);
}

TEST(InvariantSet, StatesThatNoConstraintSeesAreFree) {
  const Eigen::Matrix2d A = Eigen::Vector2d(0.5, 0.9).asDiagonal();
  const Result<controllers::InvariantSet> set = controllers::maximal_invariant_set(
      A, controllers::Polytope::box(Eigen::Vector2d(1.0, kInfinity)));
  ASSERT_TRUE(set);
  EXPECT_EQ(set->set.rows(), 2);
  EXPECT_EQ(set->set.support(Eigen::Vector2d(0.0, 1.0)), kInfinity);
}

TEST(InvariantSet, IsWhatSimulationsNeverLeave) {
  RandomStream random(1, "", "sets");
  int inside = 0, outside = 0, left_later = 0;
  for (int run = 0; run < 10; ++run) {
    const int n = 2 + run % 3;
    const Eigen::MatrixXd A = random_system(random, n, 0.6 + 0.035 * run);
    const controllers::Polytope X = random_constraints(random, n, 3 + run % 4);
    const Result<controllers::InvariantSet> result = controllers::maximal_invariant_set(A, X);
    ASSERT_TRUE(result) << result.reason();
    EXPECT_LE(invariance_excess(A, result->set, controllers::Zonotope(Eigen::MatrixXd(n, 0))),
              1e-8);
    EXPECT_TRUE(X.contains(result->set));
    for (int i = 0; i < 1000; ++i) {
      const Eigen::VectorXd start = 0.6 * normal_matrix(random, n, 1);
      bool kept = true;
      Eigen::VectorXd x = start;
      // 0.95^400 is 1e-9: what has not left by then is inside for good.
      for (int k = 0; k < 400 && kept; ++k, x = A * x) kept = X.contains(x);
      EXPECT_EQ(result->set.contains(start), kept) << "system " << run << ", point " << i;
      (kept ? inside : outside) += 1;
      left_later += !kept && X.contains(start);
    }
  }
  EXPECT_GT(inside, 1500);
  EXPECT_GT(outside, 1500);
  EXPECT_GT(left_later, 100);
}

TEST(RobustInvariantSet, NegativeScalarLeavesRoomForTheDisturbance) {
  // x+ = -x/2 + w, |w| <= 1/5, x in [-3, 1]: -x/2 + 1/5 <= 1 asks x >= -1.6; nothing else cuts.
  const controllers::Polytope line =
      controllers::Polytope::box(Eigen::VectorXd::Constant(1, -3.0), Eigen::VectorXd::Ones(1));
  const Result<controllers::InvariantSet> set = controllers::maximal_robust_invariant_set(
      Eigen::MatrixXd::Constant(1, 1, -0.5), line,
      controllers::Zonotope::box(Eigen::VectorXd::Constant(1, 0.2)));
  ASSERT_TRUE(set);
  EXPECT_TRUE(same_set(set->set, controllers::Polytope::box(Eigen::VectorXd::Constant(1, -1.6),
                                                            Eigen::VectorXd::Ones(1))));
}

/// True where no choice of w_k = +-e over `steps` steps leads out of X.
bool survives(const Eigen::Matrix2d& A, const controllers::Polytope& X, const Eigen::Vector2d& e,
              const Eigen::Vector2d& x, int steps) {
  if (!X.contains(x)) return false;
  if (steps == 0) return true;
  return survives(A, X, e, A * x + e, steps - 1) && survives(A, X, e, A * x - e, steps - 1);
}

TEST(RobustInvariantSet, IsWhatNoSequenceOfGustsLeadsOutOf) {
  // All 2^12 sequences. Later gusts reach 0.35^12 = 3e-6 of the first one's effect: no point of
  // these lies that near to the edge.
  RandomStream random(2, "", "sets");
  int inside = 0, outside = 0, by_gusts_alone = 0;
  for (int run = 0; run < 5; ++run) {
    const Eigen::Matrix2d A = random_system(random, 2, 0.35);
    const controllers::Polytope X = random_constraints(random, 2, 4);
    const Eigen::Vector2d e = 0.2 * normal_matrix(random, 2, 1);
    const controllers::Zonotope W{Eigen::MatrixXd(e)};
    const Result<controllers::InvariantSet> result =
        controllers::maximal_robust_invariant_set(A, X, W);
    ASSERT_TRUE(result) << result.reason();
    EXPECT_LE(invariance_excess(A, result->set, W), 1e-8);
    EXPECT_TRUE(X.contains(result->set));
    const Result<controllers::InvariantSet> nominal = controllers::maximal_invariant_set(A, X);
    ASSERT_TRUE(nominal);
    EXPECT_TRUE(nominal->set.contains(result->set));
    for (int i = 0; i < 200; ++i) {
      // Somewhere about the edge, where it matters.
      const Eigen::Vector2d direction = normal_matrix(random, 2, 1);
      const double to_edge =
          (result->set.F() * direction).cwiseQuotient(result->set.g()).maxCoeff();
      const Eigen::Vector2d x = direction / to_edge * random.uniform(0.7, 1.2);
      const bool kept = survives(A, X, e, x, 12);
      by_gusts_alone += !kept && nominal->set.contains(x);
      EXPECT_EQ(result->set.contains(x), kept) << "system " << run << ", point " << i;
      (kept ? inside : outside) += 1;
    }
  }
  EXPECT_GT(inside, 200);
  EXPECT_GT(outside, 200);
  EXPECT_GT(by_gusts_alone, 50);
}

TEST(RobustInvariantSet, WorstGustsForARowLeadOutExactlyOutside) {
  RandomStream random(3, "", "sets");
  int inside = 0, outside = 0;
  for (int run = 0; run < 4; ++run) {
    const int n = 3 + run % 2;
    const Eigen::MatrixXd A = random_system(random, n, 0.7);
    const controllers::Polytope X = random_constraints(random, n, 4);
    const controllers::Zonotope W{Eigen::MatrixXd(0.02 * normal_matrix(random, n, 2))};
    const Result<controllers::InvariantSet> result =
        controllers::maximal_robust_invariant_set(A, X, W);
    ASSERT_TRUE(result) << result.reason();
    for (int i = 0; i < 100; ++i) {
      const Eigen::VectorXd start = 0.5 * normal_matrix(random, n, 1);
      bool kept = true;
      for (int row = 0; row < X.rows() && kept; ++row) {
        for (int last = 0; last <= 40 && kept; ++last) {
          // The gust at step k reaches the row by F A^(last - 1 - k): it takes the sign of that.
          std::vector<Eigen::VectorXd> reach{X.F().row(row)};
          for (int k = 1; k < last; ++k) reach.push_back(A.transpose() * reach.back());
          Eigen::VectorXd x = start;
          for (int k = 0; k < last; ++k) {
            const Eigen::VectorXd c =
                W.generators().transpose() * reach[static_cast<std::size_t>(last - 1 - k)];
            x = A * x + W.generators() * c.cwiseSign();
          }
          kept = X.F().row(row).dot(x) <= X.g()[row];
        }
      }
      EXPECT_EQ(result->set.contains(start), kept) << "system " << run << ", point " << i;
      (kept ? inside : outside) += 1;
    }
  }
  EXPECT_GT(inside, 50);
  EXPECT_GT(outside, 50);
}

TEST(InvariantSet, RefusesInOneSentenceWithNumbers) {
  const controllers::Polytope box = controllers::Polytope::box(Eigen::Vector2d(1.0, 1.0));
  const controllers::Zonotope gust = controllers::Zonotope::box(Eigen::Vector2d(0.05, 0.6));
  const Eigen::Matrix2d A = Eigen::Vector2d(0.9, 0.5).asDiagonal();
  const Eigen::Matrix2d unstable = Eigen::Vector2d(-1.25, 0.5).asDiagonal();
  EXPECT_EQ(controllers::maximal_invariant_set(unstable, box).reason(),
            "A is not Schur stable: its spectral radius is 1.25, must be < 1");
  EXPECT_EQ(controllers::maximal_robust_invariant_set(unstable, box, gust).reason(),
            "A is not Schur stable: its spectral radius is 1.25, must be < 1");
  EXPECT_EQ(
      controllers::maximal_invariant_set(
          A, controllers::Polytope::box(Eigen::Vector2d(0.0, -1.0), Eigen::Vector2d(1.0, 1.0)))
          .reason(),
      "the origin is not inside the constraints: row 1 has the limit -0, must be > 0");
  EXPECT_EQ(controllers::maximal_robust_invariant_set(A, box, gust).reason(),
            "the disturbance is too large: alone it brings row 2 of the constraints to 1.2, the "
            "limit is 1");
  controllers::InvariantSettings few;
  few.max_steps = 1;
  Eigen::Matrix2d turn;
  turn << 0.0, -0.5, 0.5, 0.0;
  EXPECT_EQ(
      controllers::maximal_invariant_set(
          turn,
          controllers::Polytope::box(Eigen::Vector2d(-8.0, -0.75), Eigen::Vector2d(1.0, 10.0)), few)
          .reason(),
      "the invariant set does not converge in 1 steps: row 3 still cuts off 1.75 of its limit "
      "0.75");
  EXPECT_EQ(
      complaint([&] { (void)controllers::maximal_invariant_set(Eigen::Matrix3d::Zero(), box); }),
      "A is 3 x 3 but the constraints are in 2 dimensions");
  EXPECT_EQ(complaint([&] { (void)controllers::maximal_invariant_set(kNaN * A, box); }),
            "A contains a number that is not finite");
}

TEST(InvariantSet, ExcessTellsHowFarASetIsLeft) {
  // x+ = 0.9 x + w, |w| <= 0.3 from |x| <= 2 reaches 2.1; the row is 2 x <= 4.
  const controllers::Polytope line(2.0 * Eigen::MatrixXd::Ones(1, 1),
                                   Eigen::VectorXd::Constant(1, 4.0));
  const controllers::Zonotope W = controllers::Zonotope::box(Eigen::VectorXd::Constant(1, 0.3));
  EXPECT_NEAR(invariance_excess(Eigen::MatrixXd::Constant(1, 1, 0.9), line, W), 0.1, 1e-12);
  EXPECT_NEAR(invariance_excess(Eigen::MatrixXd::Constant(1, 1, 0.8), line, W), -0.1, 1e-12);
  EXPECT_EQ(invariance_excess(Eigen::MatrixXd::Ones(1, 1), controllers::Polytope::empty_set(1), W),
            -kInfinity);
}

TEST(InvariantSet, SameBitsTwice) {
  RandomStream first(5, "", "sets"), second(5, "", "sets");
  const auto make = [](RandomStream& random) {
    const Eigen::MatrixXd A = random_system(random, 4, 0.9);
    const controllers::Polytope X = random_constraints(random, 4, 5);
    return controllers::maximal_robust_invariant_set(
        A, X, controllers::Zonotope::box(Eigen::VectorXd::Constant(4, 0.01)));
  };
  const Result<controllers::InvariantSet> one = make(first), two = make(second);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->set.F(), two->set.F());
  EXPECT_EQ(one->set.g(), two->set.g());
}

}  // namespace
}  // namespace vinerow::test::invariant_set_test
