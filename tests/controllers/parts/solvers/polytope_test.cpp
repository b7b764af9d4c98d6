#include "controllers/parts/solvers/polytope.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/controllers/parts/solvers/random_sets.h"

namespace vinerow::test::polytope_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// {x : |x_1| + ... + |x_n| <= 1} by its 2^n rows.
controllers::Polytope one_norm_ball(int n) {
  Eigen::MatrixXd F(1 << n, n);
  for (int i = 0; i < F.rows(); ++i) {
    for (int j = 0; j < n; ++j) F(i, j) = (i >> j) & 1 ? 1.0 : -1.0;
  }
  return {F, Eigen::VectorXd::Ones(F.rows())};
}

controllers::Polytope whole_space(int dimension) {
  return {Eigen::MatrixXd(0, dimension), Eigen::VectorXd(0)};
}

/// Every vertex, by solving for each choice of three rows: a second way without programmes.
std::vector<Eigen::Vector3d> vertices(const controllers::Polytope& P) {
  std::vector<Eigen::Vector3d> found;
  for (int i = 0; i < P.rows(); ++i) {
    for (int j = 0; j < i; ++j) {
      for (int k = 0; k < j; ++k) {
        Eigen::Matrix3d rows;
        rows << P.F().row(i), P.F().row(j), P.F().row(k);
        const Eigen::Vector3d point =
            rows.partialPivLu().solve(Eigen::Vector3d(P.g()[i], P.g()[j], P.g()[k]));
        if (point.allFinite() && P.contains(point, 1e-10)) found.push_back(point);
      }
    }
  }
  return found;
}

controllers::Polytope random_polytope(RandomStream& random, int rows) {
  return random_constraints(random, Eigen::Vector3d(2.0, 3.0, 4.0), rows);
}

TEST(Polytope, SupportOfBoxAndOneNormBall) {
  RandomStream random(1, "", "polytope");
  for (int n = 1; n <= 8; ++n) {
    const Eigen::VectorXd c = normal_matrix(random, n, 1);
    const Eigen::VectorXd half = normal_matrix(random, n, 1).cwiseAbs();
    EXPECT_NEAR(controllers::Polytope::box(half).support(c), half.dot(c.cwiseAbs()), 1e-12);
    EXPECT_NEAR(one_norm_ball(n).support(c), c.cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Polytope, SupportOfUnboundedAndEmptySets) {
  const Eigen::Vector2d upper(1.0, kInfinity), lower(-kInfinity, -2.0);
  const controllers::Polytope quarter = controllers::Polytope::box(lower, upper);
  EXPECT_EQ(quarter.rows(), 2);
  EXPECT_EQ(quarter.support(Eigen::Vector2d(1.0, -1.0)), 3.0);
  EXPECT_EQ(quarter.support(Eigen::Vector2d(-1.0, 0.0)), kInfinity);
  EXPECT_EQ(controllers::Polytope::empty_set(2).support(Eigen::Vector2d(1.0, 0.0)), -kInfinity);
  EXPECT_EQ(whole_space(2).support(Eigen::Vector2d(1.0, 0.0)), kInfinity);
}

TEST(Polytope, SupportIsTheBestOfAllVertices) {
  RandomStream random(2, "", "polytope");
  for (int run = 0; run < 20; ++run) {
    const controllers::Polytope P = random_polytope(random, 20);
    const std::vector<Eigen::Vector3d> corners = vertices(P);
    ASSERT_GE(corners.size(), 4u);
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d c = normal_matrix(random, 3, 1);
      double best = -kInfinity;
      for (const Eigen::Vector3d& corner : corners) best = std::max(best, c.dot(corner));
      EXPECT_NEAR(P.support(c), best, 1e-9);
    }
  }
}

TEST(Polytope, RowsThatStayAreThoseWithAFace) {
  RandomStream random(3, "", "polytope");
  int dropped = 0;
  for (int run = 0; run < 20; ++run) {
    const controllers::Polytope P = random_polytope(random, 24);
    const std::vector<Eigen::Vector3d> corners = vertices(P);
    std::vector<int> with_face;
    for (int i = 0; i < P.rows(); ++i) {
      int on_row = 0;
      for (const Eigen::Vector3d& corner : corners) {
        on_row += std::abs(P.F().row(i).dot(corner) - P.g()[i]) < 1e-9;
      }
      if (on_row >= 3) with_face.push_back(i);
    }
    const controllers::Polytope reduced = P.without_redundant_rows();
    EXPECT_EQ(reduced.F(), Eigen::MatrixXd(P.F()(with_face, Eigen::all)));
    EXPECT_EQ(reduced.g(), Eigen::VectorXd(P.g()(with_face)));
    dropped += P.rows() - reduced.rows();
  }
  EXPECT_GT(dropped, 100);
}

TEST(Polytope, RepeatedScaledAndEmptyRowsAreRedundant) {
  Eigen::MatrixXd F(7, 2);
  F << 1, 0, 2, 0, 0, 0, -1, 0, 0, 1, 0, -1, 1, 1;
  Eigen::VectorXd g(7);
  g << 1, 2, 0, 1, 1, 1, 2;  // the last touches the corner (1, 1) only
  const controllers::Polytope reduced = controllers::Polytope(F, g).without_redundant_rows();
  Eigen::MatrixXd expected(4, 2);
  expected << 2, 0, -1, 0, 0, 1, 0, -1;
  EXPECT_EQ(reduced.F(), expected);
  EXPECT_EQ(controllers::Polytope::empty_set(3).without_redundant_rows().rows(), 1);
  EXPECT_EQ(whole_space(3).without_redundant_rows().rows(), 0);
  // An unbounded set keeps its rows.
  EXPECT_EQ(controllers::Polytope(Eigen::RowVector2d(1.0, 1.0), Eigen::VectorXd::Ones(1))
                .without_redundant_rows()
                .rows(),
            1);
}

TEST(Polytope, Empty) {
  const controllers::Polytope box = controllers::Polytope::box(Eigen::Vector2d(1.0, 2.0));
  EXPECT_FALSE(box.is_empty());
  const auto right_of = [](double left) {
    return controllers::Polytope::box(Eigen::Vector2d(left, -2.0),
                                      Eigen::Vector2d(left + 2.0, 2.0));
  };
  EXPECT_TRUE(box.intersection(right_of(1.0 + 1e-6)).is_empty());
  EXPECT_FALSE(box.intersection(right_of(1.0)).is_empty());
  EXPECT_FALSE(whole_space(1).is_empty());
  EXPECT_TRUE(controllers::Polytope::empty_set(2).is_empty());
  // Empty although it has a direction without an end.
  const controllers::Polytope strip =
      controllers::Polytope::box(Eigen::Vector2d(0.0, -kInfinity), Eigen::Vector2d(-1.0, 0.0));
  EXPECT_TRUE(strip.is_empty());
}

TEST(Polytope, ContainsPointsAndSets) {
  const controllers::Polytope ball = one_norm_ball(3);
  EXPECT_TRUE(ball.contains(Eigen::Vector3d(0.5, -0.25, 0.25)));
  EXPECT_FALSE(ball.contains(Eigen::Vector3d(0.5, -0.25, 0.2500001)));
  EXPECT_TRUE(ball.contains(Eigen::Vector3d(0.5, -0.25, 0.2500001), 1e-6));
  EXPECT_FALSE(ball.contains(Eigen::Vector3d(0.0, kNaN, 0.0)));
  const controllers::Polytope box =
      controllers::Polytope::box(Eigen::Vector3d::Constant(1.0 / 3.0));
  EXPECT_TRUE(ball.contains(box));
  EXPECT_FALSE(ball.contains(box.scaled(1.0 + 1e-6)));
  EXPECT_FALSE(box.contains(ball));
  EXPECT_TRUE(box.contains(controllers::Polytope::empty_set(3)));
  EXPECT_FALSE(box.contains(whole_space(3)));
  EXPECT_TRUE(whole_space(3).contains(box));
}

TEST(Polytope, MappedAndScaledSetsHoldTheMappedPoints) {
  RandomStream random(4, "", "polytope");
  const controllers::Polytope P = random_polytope(random, 10);
  const Eigen::MatrixXd A = normal_matrix(random, 3, 2);
  const controllers::Polytope preimage = P.linear_preimage(A), big = P.scaled(2.5);
  int inside = 0;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d y = normal_matrix(random, 2, 1);
    const Eigen::Vector3d x = normal_matrix(random, 3, 1);
    EXPECT_EQ(preimage.contains(y), P.contains(A * y));
    EXPECT_EQ(big.contains(2.5 * x, 1e-12), P.contains(x, 1e-12));
    inside += P.contains(x);
  }
  EXPECT_GT(inside, 50);
  EXPECT_LT(inside, 950);
}

TEST(Polytope, RefusesWhatDoesNotFit) {
  const controllers::Polytope box = controllers::Polytope::box(Eigen::Vector2d(1.0, 1.0));
  const Eigen::Vector3d three(1.0, 2.0, 3.0);
  EXPECT_EQ(complaint([&] { controllers::Polytope(Eigen::MatrixXd::Ones(2, 2), three); }),
            "a polytope has 2 rows but 3 limits");
  EXPECT_EQ(complaint([&] { controllers::Polytope(Eigen::MatrixXd(0, 0), Eigen::VectorXd(0)); }),
            "a polytope needs at least one dimension");
  EXPECT_EQ(complaint([&] {
              controllers::Polytope(Eigen::MatrixXd::Ones(2, 2), Eigen::Vector2d(0.0, kInfinity));
            }),
            "row 1 of a polytope contains a number that is not finite");
  EXPECT_EQ(complaint([&] {
              controllers::Polytope(Eigen::MatrixXd::Constant(1, 2, kNaN),
                                    Eigen::VectorXd::Ones(1));
            }),
            "row 0 of a polytope contains a number that is not finite");
  EXPECT_EQ(complaint([&] { controllers::Polytope::box(Eigen::Vector2d(0.0, 0.0), three); }),
            "a box has 2 lower and 3 upper limits");
  EXPECT_EQ(complaint([&] { controllers::Polytope::box(Eigen::Vector2d(0.0, kNaN)); }),
            "limit 1 of a box is not a number");
  EXPECT_EQ(complaint([&] { box.support(three); }),
            "a polytope in 2 dimensions does not match a direction in 3");
  EXPECT_EQ(complaint([&] { box.contains(three); }),
            "a polytope in 2 dimensions does not match a point in 3");
  EXPECT_EQ(complaint([&] { box.intersection(whole_space(3)); }),
            "a polytope in 2 dimensions does not match a polytope in 3");
  EXPECT_EQ(complaint([&] { box.contains(whole_space(3)); }),
            "a polytope in 2 dimensions does not match a polytope in 3");
  EXPECT_EQ(complaint([&] { box.linear_preimage(Eigen::MatrixXd::Ones(3, 2)); }),
            "a polytope in 2 dimensions does not match the image of a matrix in 3");
  EXPECT_EQ(complaint([&] { box.scaled(0.0); }), "a polytope is scaled by 0, must be > 0");
  EXPECT_EQ(complaint([&] { box.support(Eigen::Vector2d(kNaN, 0.0)); }),
            "a linear programme of 4 rows in 2 variables failed: invalid input");
}

TEST(Polytope, SameBitsTwice) {
  RandomStream first(6, "", "polytope"), second(6, "", "polytope");
  const controllers::Polytope P = random_polytope(first, 40), Q = random_polytope(second, 40);
  const Eigen::Vector3d c(0.3, -0.7, 0.2);
  EXPECT_EQ(P.support(c), Q.support(c));
  EXPECT_EQ(P.without_redundant_rows().F(), Q.without_redundant_rows().F());
}

}  // namespace
}  // namespace vinerow::test::polytope_test
