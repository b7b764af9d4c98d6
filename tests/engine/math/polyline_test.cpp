#include "engine/math/polyline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/random.h"

namespace vinerow::polyline_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Points = std::vector<Vector2d>;
using Line = std::vector<Vector3d>;

TEST(Segment, NearestPointIsNearerThanAllOthers) {
  RandomStream random(1, "test", "segment");
  const auto draw = [&] {
    return Vector3d(random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0),
                    random.uniform(-5.0, 5.0));
  };
  for (int i = 0; i < 200; ++i) {
    const Vector3d p = draw(), a = draw(), b = draw();
    const double distance_m = distance_to_segment_m<3>(p, a, b);
    EXPECT_NEAR((nearest_on_segment<3>(p, a, b) - p).norm(), distance_m, 1e-14);
    double smallest_m = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= 1000; ++k) {
      smallest_m = std::min(smallest_m, (a + 1e-3 * k * (b - a) - p).norm());
    }
    EXPECT_LE(distance_m, smallest_m + 1e-14);
    // Half a step of at most 17.4 mm off the nearest point, and so at most that much farther.
    EXPECT_GE(distance_m, smallest_m - 0.0087);
  }
}

TEST(Segment, EndsAtItsPoints) {
  const Vector2d a(1, 1), b(5, 1);
  EXPECT_EQ(segment_share<2>({2, 7}, a, b), 0.25);
  EXPECT_EQ(segment_share<2>({-2, 5}, a, b), 0.0);
  EXPECT_EQ(distance_to_segment_m<2>({-2, 5}, a, b), 5.0);
  EXPECT_EQ(nearest_on_segment<2>({9, -2}, a, b), b);
  EXPECT_EQ(distance_to_segment_m<2>({4, 5}, a, a), 5.0);
}

TEST(Polyline, EqualsTheSearchOverAllSegmentsWhateverTheHint) {
  RandomStream random(2, "test", "polyline");
  Points points;
  for (int i = 0; i < 300; ++i) {
    points.emplace_back(random.uniform(0.0, 50.0), random.uniform(0.0, 50.0));
  }
  const Polyline line(points);
  for (int i = 0; i < 1000; ++i) {
    const Vector2d p(random.uniform(-10.0, 60.0), random.uniform(-10.0, 60.0));
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j + 1 < points.size(); ++j) {
      const Vector2d d = points[j + 1] - points[j];
      const double s = std::clamp(d.dot(p - points[j]) / d.squaredNorm(), 0.0, 1.0);
      smallest = std::min(smallest, (points[j] + s * d - p).norm());
    }
    const int hint = static_cast<int>(random.uniform(-5.0, 310.0));
    EXPECT_DOUBLE_EQ(line.nearest(p, hint).distance_m, smallest);
  }
}

TEST(Polyline, IsPositiveToTheLeft) {
  const Polyline line(Points{{0, 0}, {10, 0}});
  EXPECT_DOUBLE_EQ(line.nearest({5, 2}).signed_distance_m, 2.0);
  EXPECT_DOUBLE_EQ(line.nearest({5, -2}).signed_distance_m, -2.0);
  EXPECT_DOUBLE_EQ(line.length_m(), 10.0);
}

TEST(Polyline, TakesASinglePoint) {
  const Polyline line(Points{{1, 1}});
  EXPECT_DOUBLE_EQ(line.nearest({4, 5}).distance_m, 5.0);
}

TEST(Polyline, WithoutPointsIsInfinitelyFar) {
  EXPECT_TRUE(std::isinf(Polyline(Points{}).nearest({4, 5}).distance_m));
  EXPECT_TRUE(std::isinf(Polyline().nearest_within({4, 5}, 0, 3).distance_m));
  EXPECT_EQ(Polyline().length_m(), 0.0);
}

TEST(Polyline, PositionsByArcLength) {
  const Polyline line(Points{{0, 0}, {3, 0}, {3, 0}, {3, 4}});
  EXPECT_EQ(line.s_m(), (std::vector<double>{0, 3, 3, 7}));
  EXPECT_EQ(line.point_at(2.0), Vector2d(2, 0));
  EXPECT_EQ(line.point_at(5.0), Vector2d(3, 2));
  EXPECT_EQ(line.direction_at(2.0), Vector2d(1, 0));
  EXPECT_EQ(line.direction_at(3.0), Vector2d(0, 1));
  // Straight beyond the ends.
  EXPECT_EQ(line.point_at(-2.0), Vector2d(-2, 0));
  EXPECT_EQ(line.point_at(9.0), Vector2d(3, 6));
  EXPECT_EQ(line.s_m(line.nearest({2, 3})), 6.0);
}

TEST(Polyline, KnowsItsEnds) {
  const Polyline line(Points{{0, 0}, {3, 0}, {3, 4}});
  EXPECT_TRUE(line.is_end(line.nearest({-1, 1})));
  EXPECT_TRUE(line.is_end(line.nearest({3, 9})));
  EXPECT_FALSE(line.is_end(line.nearest({1, 1})));
  EXPECT_FALSE(line.is_end(line.nearest({4, -1})));  // the corner
}

/// Ten metres east and up by one, then five north.
const Line kBent = {{0, 0, 0}, {10, 0, 1}, {10, 5, 1}};

TEST(NearestFromAbove, FindsThePointBelowAndItsSegment) {
  const LinePoint beside = nearest_from_above(kBent, {4, -3});
  EXPECT_NEAR((beside.p - Vector3d(4, 0, 0.4)).norm(), 0.0, 1e-12);
  EXPECT_EQ(beside.edge, Vector3d(10, 0, 1));
  EXPECT_NEAR(beside.distance_m, 3.0, 1e-12);
  const LinePoint second = nearest_from_above(kBent, {12, 3});
  EXPECT_NEAR((second.p - Vector3d(10, 3, 1)).norm(), 0.0, 1e-12);
  EXPECT_EQ(second.edge, Vector3d(0, 5, 0));
  EXPECT_NEAR(second.distance_m, 2.0, 1e-12);
}

TEST(NearestFromAbove, EndsWhereTheLineEnds) {
  EXPECT_NEAR(nearest_from_above(kBent, {-3, 4}).distance_m, 5.0, 1e-12);
  EXPECT_NEAR(nearest_from_above(kBent, {13, 9}).distance_m, 5.0, 1e-12);
  // Outside the bend the corner is the nearest point of both segments: the first one counts.
  EXPECT_EQ(nearest_from_above(kBent, {13, -4}).edge, Vector3d(10, 0, 1));
}

TEST(NearestFromAbove, LeavesOutSegmentsWithoutLength) {
  EXPECT_TRUE(std::isinf(nearest_from_above(Line{}, {0, 0}).distance_m));
  EXPECT_TRUE(std::isinf(nearest_from_above(Line{{1, 2, 3}}, {0, 0}).distance_m));
  EXPECT_TRUE(std::isinf(nearest_from_above(Line{{1, 2, 3}, {1, 2, 8}}, {0, 0}).distance_m));
  EXPECT_NEAR(nearest_from_above(Line{{0, 0, 0}, {0, 0, 0}, {2, 0, 0}}, {1, 1}).distance_m, 1.0,
              1e-12);
}

}  // namespace
}  // namespace vinerow::polyline_test
