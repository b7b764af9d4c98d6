#include "controllers/parts/solvers/linear_programme.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/controllers/parts/solvers/random_sets.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::linear_programme_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Rows of lower <= x <= upper: +e_j, then -e_j.
Eigen::MatrixXd box_rows(int n) {
  Eigen::MatrixXd F(2 * n, n);
  F << Eigen::MatrixXd::Identity(n, n), -Eigen::MatrixXd::Identity(n, n);
  return F;
}

TEST(LinearProgramme, BoxHasItsOptimumInTheCornerOfTheCost) {
  RandomStream random(1, "", "lp");
  for (int n = 1; n <= 16; ++n) {
    const Eigen::VectorXd upper = normal_matrix(random, n, 1).cwiseAbs();
    const Eigen::VectorXd lower = -normal_matrix(random, n, 1).cwiseAbs();
    const Eigen::VectorXd c = normal_matrix(random, n, 1);
    Eigen::VectorXd g(2 * n);
    g << upper, -lower;
    controllers::LinearProgramme programme(n, 2 * n);
    programme.set_rows(box_rows(n), g);
    ASSERT_EQ(programme.maximise(c), controllers::LpStatus::kSolved);
    const Eigen::VectorXd corner = (c.array() > 0.0).select(upper, lower);
    EXPECT_EQ(programme.x(), corner);
    EXPECT_NEAR(programme.value(), c.dot(corner), 1e-14 * (1.0 + std::abs(c.dot(corner))));
    EXPECT_LT((programme.multipliers().head(n) - c.cwiseMax(0.0)).norm(), 1e-14);
    EXPECT_LT((programme.multipliers().tail(n) - (-c).cwiseMax(0.0)).norm(), 1e-14);
  }
}

TEST(LinearProgramme, SimplexHasItsOptimumInOneOfItsCorners) {
  // x >= 0, sum x <= 2: the largest entry of c, doubled, or the origin.
  const int n = 5;
  Eigen::MatrixXd F(n + 1, n);
  F << -Eigen::MatrixXd::Identity(n, n), Eigen::RowVectorXd::Ones(n);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(n + 1);
  g[n] = 2.0;
  controllers::LinearProgramme programme(n, n + 1);
  programme.set_rows(F, g);
  Eigen::VectorXd c(n);
  c << -1.0, 0.5, 3.0, 2.0, -4.0;
  ASSERT_EQ(programme.maximise(c), controllers::LpStatus::kSolved);
  EXPECT_EQ(programme.value(), 6.0);
  EXPECT_EQ(programme.x(), 2.0 * Eigen::VectorXd::Unit(n, 2));
  ASSERT_EQ(programme.maximise(-c.cwiseAbs()), controllers::LpStatus::kSolved);
  EXPECT_EQ(programme.value(), 0.0);
  EXPECT_EQ(programme.x(), Eigen::VectorXd::Zero(n));
}

TEST(LinearProgramme, InfeasibleRowsComeWithTheirContradiction) {
  // x + y <= 1, -x <= -2, -y <= 0.5: the first two and the last add up to 0 <= -0.5.
  Eigen::MatrixXd F(3, 2);
  F << 1, 1, -1, 0, 0, -1;
  controllers::LinearProgramme programme(2, 3);
  programme.set_rows(F, Eigen::Vector3d(1.0, -2.0, 0.5));
  ASSERT_EQ(programme.maximise(Eigen::Vector2d(1.0, 0.3)), controllers::LpStatus::kInfeasible);
  EXPECT_EQ(programme.value(), -kInfinity);
  const Eigen::VectorXd y = programme.multipliers();
  EXPECT_GT(y.minCoeff(), 0.0);
  EXPECT_LT((F.transpose() * y).norm(), 1e-15 * y.norm());
  EXPECT_LT(Eigen::Vector3d(1.0, -2.0, 0.5).dot(y), 0.0);
  // With no end along the cost either, that there is no point comes first.
  EXPECT_EQ(programme.maximise(Eigen::Vector2d(-1.0, 0.0)), controllers::LpStatus::kInfeasible);
  EXPECT_EQ(programme.maximise(Eigen::Vector2d(0.0, 0.0)), controllers::LpStatus::kInfeasible);
  programme.set_limit(1, -1.5);  // now it is the point (1.5, -0.5)
  ASSERT_EQ(programme.maximise(Eigen::Vector2d(1.0, 0.3)), controllers::LpStatus::kSolved);
  EXPECT_LT((programme.x() - Eigen::Vector2d(1.5, -0.5)).norm(), 1e-15);
}

TEST(LinearProgramme, UnboundedComesWithItsDirection) {
  Eigen::MatrixXd F(2, 3);
  F << 1, -1, 0, -1, -1, 0;
  controllers::LinearProgramme programme(3, 2);
  programme.set_rows(F, Eigen::Vector2d(0.0, -3.0));
  ASSERT_EQ(programme.maximise(Eigen::Vector3d(0.2, 1.0, 0.0)), controllers::LpStatus::kUnbounded);
  EXPECT_EQ(programme.value(), kInfinity);
  EXPECT_LE((F * programme.x()).maxCoeff(), 0.0);
  EXPECT_GT(programme.x().dot(Eigen::Vector3d(0.2, 1.0, 0.0)), 0.0);
  // Bounded along this one, although the set is not.
  ASSERT_EQ(programme.maximise(Eigen::Vector3d(0.0, -1.0, 0.0)), controllers::LpStatus::kSolved);
  EXPECT_NEAR(programme.value(), -1.5, 1e-15);
  // And no row sees the third variable at all.
  EXPECT_EQ(programme.maximise(Eigen::Vector3d(0.0, -1.0, 1e-6)),
            controllers::LpStatus::kUnbounded);
}

TEST(LinearProgramme, WithoutRows) {
  controllers::LinearProgramme programme(2, 0);
  programme.set_rows(Eigen::MatrixXd(0, 2), Eigen::VectorXd(0));
  EXPECT_EQ(programme.maximise(Eigen::Vector2d(0.0, 1.0)), controllers::LpStatus::kUnbounded);
  EXPECT_EQ(programme.maximise(Eigen::Vector2d::Zero()), controllers::LpStatus::kSolved);
  EXPECT_EQ(programme.value(), 0.0);
}

TEST(LinearProgramme, RowsOfZerosAndInfiniteLimits) {
  Eigen::MatrixXd F(4, 1);
  F << 0.0, 1.0, 1.0, -1.0;
  controllers::LinearProgramme programme(1, 4);
  programme.set_rows(F, Eigen::Vector4d(0.0, kInfinity, 3.0, 1.0));
  const Eigen::VectorXd c = Eigen::VectorXd::Ones(1);
  ASSERT_EQ(programme.maximise(c), controllers::LpStatus::kSolved);
  EXPECT_EQ(programme.value(), 3.0);
  EXPECT_EQ(programme.multipliers(), Eigen::Vector4d(0.0, 0.0, 1.0, 0.0));
  programme.set_limit(2, kInfinity);
  EXPECT_EQ(programme.maximise(c), controllers::LpStatus::kUnbounded);
  programme.set_limit(0, -1e-30);  // 0 <= -1e-30
  EXPECT_EQ(programme.maximise(c), controllers::LpStatus::kInfeasible);
  EXPECT_EQ(programme.multipliers(), Eigen::Vector4d(1.0, 0.0, 0.0, 0.0));
}

TEST(LinearProgramme, ContradictionsWithinTheToleranceAreEqualities) {
  Eigen::MatrixXd F(2, 1);
  F << 1.0, -1.0;
  controllers::LinearProgramme programme(1, 2);
  programme.set_rows(F, Eigen::Vector2d(1.0, -1.0 - 1e-10));
  ASSERT_EQ(programme.maximise(Eigen::VectorXd::Ones(1)), controllers::LpStatus::kSolved);
  EXPECT_NEAR(programme.value(), 1.0, 1e-9);
  programme.set_limit(1, -1.0 - 1e-8);
  EXPECT_EQ(programme.maximise(Eigen::VectorXd::Ones(1)), controllers::LpStatus::kInfeasible);
}

TEST(LinearProgramme, InvalidInputIsToldAndGivesNoNumbers) {
  Eigen::MatrixXd F = box_rows(2);
  Eigen::VectorXd g = Eigen::VectorXd::Ones(4);
  const Eigen::Vector2d c(1.0, 2.0);
  controllers::LinearProgramme programme(2, 4);
  const auto answer = [&] {
    programme.set_rows(F, g);
    return programme.maximise(c);
  };
  ASSERT_EQ(answer(), controllers::LpStatus::kSolved);
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_EQ(programme.maximise(Eigen::Vector2d(bad, 1.0)), controllers::LpStatus::kInvalidInput);
    F(3, 1) = bad;
    EXPECT_EQ(answer(), controllers::LpStatus::kInvalidInput);
    EXPECT_TRUE(std::isnan(programme.value()));
    EXPECT_EQ(programme.x(), Eigen::Vector2d::Zero());
    F(3, 1) = -1.0;
  }
  for (const double bad : {kNaN, -kInfinity}) {
    g[1] = bad;
    EXPECT_EQ(answer(), controllers::LpStatus::kInvalidInput);
    g[1] = 1.0;
  }
  EXPECT_EQ(answer(), controllers::LpStatus::kSolved);  // and it recovers
}

TEST(LinearProgramme, StopsAtItsIterationLimit) {
  RandomStream random(2, "", "lp");
  const Eigen::MatrixXd F = normal_matrix(random, 100, 8);
  controllers::LpSettings settings;
  settings.max_iterations = 5;
  controllers::LinearProgramme programme(8, 100, settings);
  programme.set_rows(F, Eigen::VectorXd::Ones(100));
  EXPECT_EQ(programme.maximise(normal_matrix(random, 8, 1)),
            controllers::LpStatus::kIterationLimit);
  EXPECT_TRUE(std::isnan(programme.value()));
  EXPECT_EQ(programme.x(), Eigen::VectorXd::Zero(8));
}

TEST(LinearProgramme, StatusesHaveNames) {
  EXPECT_STREQ(controllers::to_string(controllers::LpStatus::kSolved), "solved");
  EXPECT_STREQ(controllers::to_string(controllers::LpStatus::kInfeasible), "infeasible");
  EXPECT_STREQ(controllers::to_string(controllers::LpStatus::kUnbounded), "unbounded");
  EXPECT_STREQ(controllers::to_string(controllers::LpStatus::kIterationLimit), "iteration limit");
  EXPECT_STREQ(controllers::to_string(controllers::LpStatus::kInvalidInput), "invalid input");
}

TEST(LinearProgramme, SolvesWithoutHeapAndWithTheSameBitsWhateverCameBefore) {
  RandomStream random(3, "", "lp");
  const Eigen::MatrixXd F = normal_matrix(random, 300, 12);
  const Eigen::VectorXd g = Eigen::VectorXd::Ones(300), c = normal_matrix(random, 12, 1);
  const Eigen::MatrixXd other_F = normal_matrix(random, 40, 12);
  const Eigen::VectorXd other_g = -Eigen::VectorXd::Ones(40),
                        other_c = normal_matrix(random, 12, 1);
  controllers::LinearProgramme fresh(12, 300), used(12, 300);
  fresh.set_rows(F, g);
  ASSERT_EQ(fresh.maximise(c), controllers::LpStatus::kSolved);
  const AllocationCounter counter;
  used.set_rows(other_F, other_g);
  used.maximise(other_c);
  used.set_rows(F, g);
  used.maximise(other_c);
  used.set_limit(7, kInfinity);
  used.maximise(c);
  used.set_limit(7, g[7]);
  const controllers::LpStatus status = used.maximise(c);
  EXPECT_EQ(counter.count(), 0u);
  ASSERT_EQ(status, controllers::LpStatus::kSolved);
  EXPECT_EQ(used.x(), fresh.x());
  EXPECT_EQ(used.value(), fresh.value());
  EXPECT_EQ(used.multipliers(), fresh.multipliers());
  EXPECT_EQ(used.iterations(), fresh.iterations());
}

}  // namespace
}  // namespace vinerow::test::linear_programme_test
