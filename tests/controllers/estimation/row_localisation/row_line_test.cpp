#include "controllers/estimation/row_localisation/row_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace vinerow::test::row_line_test {
namespace {

using Line = std::vector<Eigen::Vector3d>;

/// Ten metres east and up by one, then five north.
const Line kBent = {{0, 0, 0}, {10, 0, 1}, {10, 5, 1}};

TEST(RowLine, FindsThePointBelowAndThePieceItLiesOn) {
  const controllers::LinePoint beside = controllers::nearest_on(kBent, {4, -3, 7});
  EXPECT_NEAR((beside.p_W - Eigen::Vector3d(4, 0, 0.4)).norm(), 0.0, 1e-12);
  EXPECT_EQ(beside.edge_W, Eigen::Vector3d(10, 0, 1));
  EXPECT_NEAR(beside.distance_m, 3.0, 1e-12);
  const controllers::LinePoint second = controllers::nearest_on(kBent, {12, 3, -2});
  EXPECT_NEAR((second.p_W - Eigen::Vector3d(10, 3, 1)).norm(), 0.0, 1e-12);
  EXPECT_EQ(second.edge_W, Eigen::Vector3d(0, 5, 0));
  EXPECT_NEAR(second.distance_m, 2.0, 1e-12);
}

TEST(RowLine, EndsWhereTheLineEnds) {
  EXPECT_NEAR(controllers::nearest_on(kBent, {-3, 4, 0}).distance_m, 5.0, 1e-12);
  EXPECT_NEAR(controllers::nearest_on(kBent, {13, 9, 0}).distance_m, 5.0, 1e-12);
  // Outside the bend both pieces have their corner nearest: the first one is told.
  EXPECT_EQ(controllers::nearest_on(kBent, {13, -4, 0}).edge_W, Eigen::Vector3d(10, 0, 1));
}

TEST(RowLine, PiecesWithoutLengthAreNone) {
  EXPECT_TRUE(std::isinf(controllers::nearest_on(Line{}, {0, 0, 0}).distance_m));
  EXPECT_TRUE(std::isinf(controllers::nearest_on(Line{{1, 2, 3}}, {0, 0, 0}).distance_m));
  EXPECT_TRUE(
      std::isinf(controllers::nearest_on(Line{{1, 2, 3}, {1, 2, 8}}, {0, 0, 0}).distance_m));
  EXPECT_NEAR(controllers::nearest_on(Line{{0, 0, 0}, {0, 0, 0}, {2, 0, 0}}, {1, 1, 0}).distance_m,
              1.0, 1e-12);
}

}  // namespace
}  // namespace vinerow::test::row_line_test
