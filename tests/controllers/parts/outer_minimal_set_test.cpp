#include "controllers/parts/outer_minimal_set.h"

#include <gtest/gtest.h>

#include <limits>

#include "controllers/parts/series_support.h"
#include "tests/controllers/parts/random_sets.h"

namespace vinerow::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(OuterMinimalSet, ReproducesTheExampleOfRakovic) {
  // The example with A_K = [-.17 -.03; -1.17 -.03] and a unit box: the set itself has half widths
  // 100/77 and 200/77.
  Eigen::Matrix2d A;
  A << -0.17, -0.03, -1.17, -0.03;
  const Polytope W = Polytope::box(Eigen::Vector2d(1.0, 1.0));
  const Result<SeriesSupport> exact = SeriesSupport::make(A, W);
  ASSERT_TRUE(exact);
  EXPECT_NEAR((*exact)(Eigen::Vector2d::UnitX()), 100.0 / 77.0, 1e-10);
  EXPECT_NEAR((*exact)(Eigen::Vector2d::UnitY()), 200.0 / 77.0, 1e-10);
  struct Case {
    double most_alpha;
    int steps;
    double first, second;
  };
  for (const Case& expected : {Case{0.1, 3, 1.3956, 2.7143}, Case{5e-4, 8, 1.298908, 2.597652}}) {
    OuterMinimalSet::Settings settings;
    settings.most_alpha = expected.most_alpha;
    const Result<OuterMinimalSet> outer = OuterMinimalSet::make(A, W, settings);
    ASSERT_TRUE(outer);
    EXPECT_EQ(outer->steps(), expected.steps);
    const double rounding = expected.steps == 3 ? 5e-5 : 5e-7;  // of the printed figures
    EXPECT_NEAR(outer->support(Eigen::Vector2d::UnitX()), expected.first, rounding);
    EXPECT_NEAR(outer->support(Eigen::Vector2d::UnitY()), expected.second, rounding);
    EXPECT_LE(outer->support(Eigen::Vector2d::UnitY()), 200.0 / 77.0 + outer->accuracy());
  }
}

TEST(OuterMinimalSet, IsInvariantAndWithinItsAccuracyOfTheSeries) {
  RandomStream random(4, "", "sets");
  for (int run = 0; run < 6; ++run) {
    const int n = 2 + run % 2;
    const Eigen::MatrixXd A = random_system(random, n, 0.8);
    const Polytope W = random_constraints(random, n, 3);
    OuterMinimalSet::Settings settings;
    settings.most_alpha = 0.5;
    settings.accuracy = 0.05;
    const Result<OuterMinimalSet> outer = OuterMinimalSet::make(A, W, settings);
    const Result<SeriesSupport> series = SeriesSupport::make(A, W);
    ASSERT_TRUE(outer && series);
    EXPECT_LE(outer->accuracy(), 0.05);
    for (int i = 0; i < 40; ++i) {
      const Eigen::VectorXd c = random_matrix(random, n, 1).normalized();
      const double reached = (*outer)(c);
      // A S + W inside S, told by supports in every direction.
      EXPECT_LE((*outer)(A.transpose() * c) + W(c), reached + 1e-9);
      EXPECT_GE(reached, (*series)(c)-1e-9);
      EXPECT_LE(reached, (*series)(c) + 0.05 * c.lpNorm<1>());
    }
  }
}

TEST(OuterMinimalSet, Refuses) {
  const Eigen::Matrix2d A = Eigen::Vector2d(0.9, 0.5).asDiagonal();
  const Polytope W = Polytope::box(Eigen::Vector2d(1.0, 1.0));
  const OuterMinimalSet::Settings settings;
  EXPECT_EQ(OuterMinimalSet::make(2.0 * A, W, settings).reason(),
            "A is not Schur stable: its spectral radius is 1.8, must be < 1");
  EXPECT_EQ(OuterMinimalSet::make(A, Polytope::box(Eigen::Vector2d(1.0, 0.0)), settings).reason(),
            "the origin is not inside the disturbance set: its row 2 has the limit 0, must be > 0");
  EXPECT_EQ(
      OuterMinimalSet::make(A, Polytope::box(Eigen::Vector2d(1.0, kInfinity)), settings).reason(),
      "the disturbance set has no end along state 1");
  OuterMinimalSet::Settings few;
  few.max_steps = 3;
  EXPECT_EQ(OuterMinimalSet::make(A, W, few).reason(),
            "the outer minimal set is not finished in 3 steps: alpha is 0.729, wanted 0.02");
  EXPECT_EQ(complaint([&] { (void)OuterMinimalSet::make(Eigen::Matrix3d::Zero(), W, settings); }),
            "A is 3 x 3 but the disturbance is in 2 dimensions");
  EXPECT_EQ(complaint([&] { (*OuterMinimalSet::make(A, W, settings))(Eigen::Vector3d::Ones()); }),
            "a set in 2 dimensions meets a direction in 3");
}

}  // namespace
}  // namespace vinerow::test
