#include "engine/math/polyline_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "engine/core/random.h"

namespace vinerow::polyline_index_test {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

PolylineIndex index_of(const std::vector<Points>& lines) {
  std::vector<Polyline> polylines;
  for (const Points& points : lines) polylines.emplace_back(points);
  return PolylineIndex(std::move(polylines));
}

struct Found {
  double distance_m = kInfinity;
  int line = -1, segment = 0;
};

/// The two nearest lines, by a loop over all segments of one line after the other.
std::array<Found, 2> search_all(const std::vector<Points>& lines, const Vector2d& p) {
  Found first, second;
  for (std::size_t k = 0; k < lines.size() && p.allFinite(); ++k) {
    Found nearest;
    for (std::size_t i = 0; i + 1 < lines[k].size(); ++i) {
      const Vector2d &a = lines[k][i], d = lines[k][i + 1] - a;
      if (!a.allFinite() || !d.allFinite() || d.isZero()) continue;
      const double t = (p - a).dot(d) / d.squaredNorm();
      const Vector2d at = a + std::min(std::max(t, 0.0), 1.0) * d;
      const double distance_m = (p - at).norm();
      if (distance_m < nearest.distance_m) {
        nearest = {distance_m, static_cast<int>(k), static_cast<int>(i)};
      }
    }
    if (nearest.distance_m < first.distance_m) {
      second = first;
      first = nearest;
    } else if (nearest.distance_m < second.distance_m) {
      second = nearest;
    }
  }
  return {first, second};
}

void expect_same(const PolylineIndex::Nearest& found, const Found& expected) {
  EXPECT_EQ(found.distance_m, expected.distance_m);
  EXPECT_EQ(found.line, expected.line);
  EXPECT_EQ(found.segment, expected.segment);
}

void expect_as_search_of_all(const std::vector<Points>& lines, const PolylineIndex& index,
                             const Vector2d& p) {
  SCOPED_TRACE(::testing::Message() << "at " << p.transpose());
  const std::array<Found, 2> expected = search_all(lines, p);
  const auto [first, second] = index.nearest_two(p);
  expect_same(first, expected[0]);
  expect_same(second, expected[1]);
  expect_same(index.nearest(p), expected[0]);
}

/// Segments of 1.5 m, bent sideways by up to 0.3 m at each point.
std::vector<Points> bent_rows(int rows, double azimuth_rad, RandomStream& random) {
  const Vector2d along(std::cos(azimuth_rad), std::sin(azimuth_rad)), left(-along.y(), along.x());
  std::vector<Points> lines(rows);
  for (int k = 0; k < rows; ++k) {
    for (int i = 0; i <= 40; ++i) {
      lines[k].push_back(1.5 * i * along + (2.5 * k + random.uniform(-0.3, 0.3)) * left);
    }
  }
  return lines;
}

TEST(PolylineIndex, FindsWhatASearchOfAllSegmentsFinds) {
  RandomStream random(1, "", "rows");
  for (const double azimuth_rad : {0.0, 0.5, 0.785, 2.0}) {
    const std::vector<Points> lines = bent_rows(12, azimuth_rad, random);
    const PolylineIndex index = index_of(lines);
    for (int i = 0; i < 3000; ++i) {
      const double reach_m = i % 10 == 0 ? 2000.0 : 80.0;
      expect_as_search_of_all(
          lines, index, {random.uniform(-reach_m, reach_m), random.uniform(-reach_m, reach_m)});
    }
  }
}

TEST(PolylineIndex, VisitsEverySegmentWithinReach) {
  RandomStream random(5, "", "rows");
  const std::vector<Points> lines = bent_rows(12, 0.6, random);
  const PolylineIndex index = index_of(lines);
  std::size_t needed = 0, visited = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector2d p(random.uniform(-30.0, 60.0), random.uniform(-10.0, 60.0));
    const double reach_m = random.uniform(0.0, 4.0);
    std::set<std::pair<int, int>> within, seen;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      for (std::size_t n = 0; n + 1 < lines[k].size(); ++n) {
        const Found alone = search_all({{lines[k][n], lines[k][n + 1]}}, p)[0];
        if (alone.distance_m <= reach_m) within.emplace(k, n);
      }
    }
    index.visit_within(p, reach_m, [&](const PolylineIndex::Nearest& at) {
      EXPECT_TRUE(seen.emplace(at.line, at.segment).second) << "twice";
      const Points& line = lines[at.line];
      const Found alone = search_all({{line[at.segment], line[at.segment + 1]}}, p)[0];
      EXPECT_EQ(at.distance_m, alone.distance_m);
    });
    EXPECT_TRUE(std::includes(seen.begin(), seen.end(), within.begin(), within.end()));
    needed += within.size();
    visited += seen.size();
  }
  // Boxes along the rows keep what is visited in vain small, however the rows lie.
  EXPECT_GT(needed, 500u);
  EXPECT_LT(visited, 4 * needed);
}

TEST(PolylineIndex, AgreesWithEachPolyline) {
  RandomStream random(2, "", "rows");
  const PolylineIndex index = index_of(bent_rows(6, 0.3, random));
  for (int i = 0; i < 1000; ++i) {
    const Vector2d p(random.uniform(-20.0, 70.0), random.uniform(-20.0, 40.0));
    const PolylineIndex::Nearest found = index.nearest(p);
    for (std::size_t k = 0; k < index.lines().size(); ++k) {
      const Polyline::Nearest own = index.lines()[k].nearest(p);
      EXPECT_GE(own.distance_m, found.distance_m);
      if (static_cast<int>(k) != found.line) continue;
      EXPECT_EQ(own.distance_m, found.distance_m);
      EXPECT_EQ(own.signed_distance_m, found.signed_distance_m);
      EXPECT_EQ(own.segment, found.segment);
      EXPECT_EQ(own.fraction, found.fraction);
      EXPECT_EQ(own.point, found.point);
    }
  }
}

TEST(PolylineIndex, OfEqualsTakesTheFirst) {
  // Points of a chessboard: the middle of a square is as far from two lines, a place between two
  // points as far from two segments, and the last line covers the third.
  std::vector<Points> lines;
  for (const int k : {0, 1, 2, 3, 4, 2}) {
    Points points;
    for (int i = 0; i <= 20; ++i) points.emplace_back(2 * i, 2 * k);
    lines.push_back(points);
  }
  const PolylineIndex index = index_of(lines);
  for (int x = -2; x <= 42; ++x) {
    for (int y = -2; y <= 10; ++y) expect_as_search_of_all(lines, index, Vector2d(x, y));
  }
  // By hand: 1 m from lines 0 and 1; on lines 2 and 5 between segments 4 and 5.
  const auto [first, second] = index.nearest_two({5, 1});
  EXPECT_EQ(first.line, 0);
  EXPECT_EQ(second.line, 1);
  const auto [upper, same] = index.nearest_two({10, 4});
  EXPECT_EQ(upper.line, 2);
  EXPECT_EQ(upper.segment, 4);
  EXPECT_EQ(same.line, 5);
}

TEST(PolylineIndex, LeavesOutSegmentsWithoutLengthOrPlace) {
  const std::vector<Points> lines = {{{0, 0}, {0, 0}},
                                     {{kNan, 0}, {1, 1}, {9, 1}},  // its second segment counts
                                     {},
                                     {{3, 3}},
                                     {{0, 4}, {8, 4}, {kInfinity, 4}}};
  const PolylineIndex index = index_of(lines);
  for (const Vector2d& p : {Vector2d(4, 2), Vector2d(0, 0), Vector2d(30, 5), Vector2d(kNan, 0),
                            Vector2d(0, kInfinity)}) {
    expect_as_search_of_all(lines, index, p);
  }
  const auto [first, second] = index.nearest_two({4, 2});
  EXPECT_EQ(first.point, Vector2d(4, 1));
  EXPECT_EQ(second.point, Vector2d(4, 4));
  EXPECT_EQ(PolylineIndex().nearest({0, 0}).line, -1);
  EXPECT_EQ(index_of({{{0, 0}, {1, 0}}}).nearest_two({0, 0})[1].line, -1);
}

}  // namespace
}  // namespace vinerow::polyline_index_test
