#include "controllers/estimation/row_localisation/row_line_index.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "tests/controllers/support/row_mesh_map.h"

namespace vinerow::test::row_line_index_test {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Row after row.
controllers::RowLineIndex::NearestRows search_all(const RowMap& map, const Vector3d& p_W) {
  controllers::LinePoint first, second;
  for (const PlantRow& row : map.rows) {
    const controllers::LinePoint point = controllers::nearest_on(row.line_W, p_W);
    if (point.distance_m < first.distance_m) {
      second = first;
      first = point;
    } else if (point.distance_m < second.distance_m) {
      second = point;
    }
  }
  return {first, second};
}

void expect_same(const controllers::LinePoint& found, const controllers::LinePoint& expected) {
  EXPECT_EQ(found.distance_m, expected.distance_m);
  EXPECT_EQ(found.p_W, expected.p_W);
  EXPECT_EQ(found.edge_W, expected.edge_W);
}

void expect_as_search_of_all(const RowMap& map, const controllers::RowLineIndex& index,
                             const Vector3d& p_W) {
  SCOPED_TRACE(::testing::Message() << "at " << p_W.transpose());
  const auto found = index.nearest_rows(p_W), expected = search_all(map, p_W);
  expect_same(found.first, expected.first);
  expect_same(found.second, expected.second);
}

PlantRow row_along(std::vector<Vector3d> line_W) {
  PlantRow row;
  row.line_W = std::move(line_W);
  return row;
}

/// Pieces of 1.5 m, bent sideways by up to 0.3 m at each point.
RowMap bent_rows(int rows, double azimuth_rad, RandomStream& random) {
  const Vector3d along(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.1);
  const Vector3d left(-along.y(), along.x(), 0.0);
  RowMap map;
  for (int k = 0; k < rows; ++k) {
    std::vector<Vector3d> line_W;
    for (int i = 0; i <= 40; ++i) {
      line_W.push_back(1.5 * i * along + (2.5 * k + random.uniform(-0.3, 0.3)) * left);
    }
    map.rows.push_back(row_along(std::move(line_W)));
  }
  return map;
}

TEST(RowLineIndex, FindsWhatASearchOfAllRowsFinds) {
  RandomStream random(1, "", "rows");
  for (const double azimuth_rad : {0.0, 0.5, 0.785, 2.0}) {
    const RowMap map = bent_rows(12, azimuth_rad, random);
    const controllers::RowLineIndex index(map);
    for (int i = 0; i < 3000; ++i) {
      const double reach_m = i % 10 == 0 ? 2000.0 : 80.0;
      expect_as_search_of_all(map, index,
                              {random.uniform(-reach_m, reach_m), random.uniform(-reach_m, reach_m),
                               random.uniform(-5.0, 5.0)});
    }
  }
}

TEST(RowLineIndex, OfEqualsTakesTheFirst) {
  // Points of a chessboard: a place in the middle of a square is as far from two rows, one between
  // two points as far from two pieces, and the last row lies upon the third.
  RowMap map;
  for (const int k : {0, 1, 2, 3, 4, 2}) {
    std::vector<Vector3d> line_W;
    for (int i = 0; i <= 20; ++i) line_W.emplace_back(2 * i, 2 * k, i % 2 + 10 * map.rows.size());
    map.rows.push_back(row_along(std::move(line_W)));
  }
  const controllers::RowLineIndex index(map);
  for (int x = -2; x <= 42; ++x) {
    for (int y = -2; y <= 10; ++y) expect_as_search_of_all(map, index, Vector3d(x, y, 1.0));
  }
  // By hand: 1 m from rows 0 and 1, which are 10 m apart in height.
  const auto [first, second] = index.nearest_rows({5, 1, 0});
  EXPECT_EQ(first.p_W, Vector3d(5, 0, 0.5));
  EXPECT_EQ(second.p_W, Vector3d(5, 2, 10.5));
}

TEST(RowLineIndex, TakesRowsOfOnePiece) {
  const RowMap map = make_row_mesh_map({.rows = 16, .length_m = 118.0}, RandomStream(1, "", "map"));
  const controllers::RowLineIndex index(map);
  RandomStream random(2, "", "places");
  for (int i = 0; i < 1000; ++i) {
    expect_as_search_of_all(map, index,
                            {random.uniform(-20.0, 130.0), random.uniform(-70.0, 60.0), 1.0});
  }
}

TEST(RowLineIndex, LeavesOutWhatHasNoPlace) {
  RowMap map;
  map.rows = {row_along({{0, 0, 0}, {0, 0, 5}}),                // of no length
              row_along({{kNan, 0, 0}, {1, 1, 0}, {9, 1, 0}}),  // its second piece is one
              row_along({}), row_along({{3, 3, 3}}),
              row_along({{0, 4, 0}, {8, 4, 0}, {kInfinity, 4, 0}})};
  const controllers::RowLineIndex index(map);
  for (const Vector3d& p_W : {Vector3d(4, 2, 0), Vector3d(0, 0, 0), Vector3d(30, 5, kNan),
                              Vector3d(kNan, 0, 0), Vector3d(0, kInfinity, 0)}) {
    expect_as_search_of_all(map, index, p_W);
  }
  const auto [first, second] = index.nearest_rows({4, 2, 0});
  EXPECT_EQ(first.p_W, Vector3d(4, 1, 0));
  EXPECT_EQ(second.p_W, Vector3d(4, 4, 0));
  EXPECT_TRUE(
      std::isinf(controllers::RowLineIndex(RowMap{}).nearest_rows({0, 0, 0}).first.distance_m));
}

}  // namespace
}  // namespace vinerow::test::row_line_index_test
