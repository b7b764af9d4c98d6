#include "engine/math/polygon.h"

#include <gtest/gtest.h>

#include "engine/core/random.h"

namespace vinerow::polygon_test {
namespace {

using Eigen::Vector2d;

const Polygon kUnit = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
/// An L of area 3: a square of 2 m without its upper right quarter.
const Polygon kL = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};

Polygon moved(Polygon polygon, const Vector2d& by) {
  for (Vector2d& p : polygon) p += by;
  return polygon;
}

TEST(Polygon, AreaHasTheSignOfTheTurn) {
  EXPECT_DOUBLE_EQ(signed_area_m2(kUnit), 1.0);
  EXPECT_DOUBLE_EQ(signed_area_m2(kL), 3.0);
  EXPECT_DOUBLE_EQ(signed_area_m2({{0, 0}, {0, 1}, {1, 0}}), -0.5);
  EXPECT_EQ(signed_area_m2({{0, 0}, {5, 5}}), 0.0);
  EXPECT_NEAR(signed_area_m2(moved(kL, {1e7, -1e7})), 3.0, 1e-9);
}

TEST(Polygon, ContainsByTheEvenOddRule) {
  EXPECT_TRUE(contains(kL, {0.5, 1.5}));
  EXPECT_TRUE(contains(kL, {1.5, 0.5}));
  EXPECT_FALSE(contains(kL, {1.5, 1.5}));
  EXPECT_FALSE(contains(kL, {-0.5, 0.5}));
}

TEST(Polygon, DistanceIsToTheNearestEdgeOrCorner) {
  EXPECT_EQ(distance_m(kL, {0.5, 1.5}), 0.0);
  EXPECT_DOUBLE_EQ(distance_m(kL, {3.0, 0.5}), 1.0);
  EXPECT_DOUBLE_EQ(distance_m(kL, {1.25, 1.75}), 0.25);
  EXPECT_DOUBLE_EQ(distance_m(kL, {-3.0, -4.0}), 5.0);
}

TEST(Polygon, CutKeepsWhatIsLeftOfALine) {
  EXPECT_EQ(cut(kUnit, {0.25, 0}, {0, 1}), (Polygon{{0, 0}, {0.25, 0}, {0.25, 1}, {0, 1}}));
  EXPECT_DOUBLE_EQ(signed_area_m2(cut(kUnit, {0, 0}, {1, 1})), 0.5);
  EXPECT_EQ(cut(kUnit, {0, 0}, {1, 1}).size(), 3u);  // through corners: none stands twice
  EXPECT_EQ(cut(kUnit, {0, 2}, {-1, 0}), kUnit);
  EXPECT_TRUE(cut(kUnit, {0, 2}, {1, 0}).empty());
  EXPECT_TRUE(cut(kUnit, {0, 1}, {1, 0}).empty());  // an edge has no area
}

TEST(Polygon, LinesRunInsideFromEdgeToEdge) {
  EXPECT_EQ(clip_line(kUnit, {-2.0, 0.5}, {0.5, 0.0}), Vector2d(4.0, 6.0));
  EXPECT_EQ(clip_line(kUnit, {0.5, 0.5}, {0.0, -1.0}), Vector2d(-0.5, 0.5));
  const Vector2d diagonal = clip_line(kUnit, {-1.0, -1.0}, {1.0, 1.0});
  EXPECT_DOUBLE_EQ(diagonal[0], 1.0);
  EXPECT_DOUBLE_EQ(diagonal[1], 2.0);
  for (const Vector2d& d : {Vector2d(1, 0), Vector2d(1, 0.1), Vector2d(-1, 0.1)}) {
    const Vector2d missed = clip_line(kUnit, {-1.0, 1.5}, d);
    EXPECT_GE(missed[0], missed[1]) << d.transpose();
  }
}

TEST(Polygon, TheHullLeavesOutWhatLiesInsideOrOnAnEdge) {
  const Polygon hull =
      convex_hull({{1, 1}, {0, 0}, {2, 0}, {1, 0}, {2, 2}, {0, 2}, {0, 0}, {0.5, 1}});
  EXPECT_EQ(hull, (Polygon{{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
}

TEST(Polygon, ClippingSquares) {
  EXPECT_NEAR(signed_area_m2(clip(kUnit, moved(kUnit, {0.25, 0.5}))), 0.75 * 0.5, 1e-15);
  EXPECT_NEAR(signed_area_m2(clip(kUnit, kUnit)), 1.0, 1e-15);
  EXPECT_EQ(signed_area_m2(clip(kUnit, moved(kUnit, {1.5, 0}))), 0.0);
  // A diamond of area 2 about the origin: a quarter of it, the triangle (0,0) (1,0) (0,1).
  EXPECT_NEAR(signed_area_m2(clip(kUnit, {{1, 0}, {0, 1}, {-1, 0}, {0, -1}})), 0.5, 1e-15);
}

TEST(Polygon, ASubjectThatFallsApartKeepsItsArea) {
  // A bar across the two arms of a U.
  const Polygon u = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  const Polygon bar = {{-1, 2}, {4, 2}, {4, 2.5}, {-1, 2.5}};
  EXPECT_NEAR(signed_area_m2(clip(u, bar)), 2 * 0.5, 1e-15);
}

TEST(Polygon, ClippedTrianglesAgreeWithPointsCounted) {
  RandomStream random(7, "", "polygon_test");
  for (int round = 0; round < 20; ++round) {
    const auto triangle = [&] {
      Polygon p;
      for (int i = 0; i < 3; ++i) p.emplace_back(random.uniform(0, 1), random.uniform(0, 1));
      return convex_hull(p);
    };
    const Polygon a = triangle(), b = triangle();
    constexpr int kPerSide = 400;
    int both = 0;
    for (int i = 0; i < kPerSide * kPerSide; ++i) {
      const Vector2d p((i % kPerSide + 0.5) / kPerSide, (i / kPerSide + 0.5) / kPerSide);
      both += contains(a, p) && contains(b, p);
    }
    // A boundary of length at most 4 errs by at most half a cell along it.
    EXPECT_NEAR(signed_area_m2(clip(a, b)), both / double(kPerSide * kPerSide), 2.0 / kPerSide);
    EXPECT_NEAR(signed_area_m2(clip(a, b)), signed_area_m2(clip(b, a)), 1e-14);
  }
}

TEST(Polygon, FindsWhereItCrossesItself) {
  EXPECT_FALSE(find_crossing(kUnit));
  EXPECT_FALSE(find_crossing(kL));
  EXPECT_EQ(find_crossing({{0, 0}, {2, 2}, {2, 0}, {0, 2}}), (std::pair{0, 2})) << "a bow tie";
  EXPECT_EQ(find_crossing({{0, 0}, {2, 0}, {1, 0}, {1, 1}}), (std::pair{0, 1})) << "runs back";
  EXPECT_EQ(find_crossing({{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}}), (std::pair{0, 2}))
      << "a corner on another edge";
}

TEST(Polygon, LosesRepeatedCornersAndTheClosingOne) {
  EXPECT_EQ(without_repeats({{0, 0}, {0, 0}, {9, 0}, {9, 9}, {0, 0}}),
            (Polygon{{0, 0}, {9, 0}, {9, 9}}));
}

TEST(Polygon, WidensEveryEdge) {
  const Polygon square = {{0, 0}, {100, 0}, {100, 100}, {0, 100}};
  EXPECT_NEAR(signed_area_m2(widen(square, 10.0)), 120.0 * 120.0, 1e-9);
  // Clockwise too, and inwards.
  EXPECT_NEAR(signed_area_m2(widen({square.rbegin(), square.rend()}, -10.0)), -80.0 * 80.0, 1e-9);
  EXPECT_EQ(widen(square, 0.0), square);
  // Nothing is left of a square of 100 m that loses 51 m on each side.
  EXPECT_TRUE(widen(square, -51.0).empty());
  // An arrow head: its sharp tips are cut off at twice the margin, and all of it stays inside.
  const Polygon arrow = {{0, 0}, {200, 100}, {0, 200}, {80, 100}};
  const Polygon wide = widen(arrow, 5.0);
  EXPECT_FALSE(find_crossing(wide));
  for (const Vector2d& p : arrow) EXPECT_TRUE(contains(wide, p));
  for (const Vector2d& p : wide) EXPECT_LT(distance_m(arrow, p), 2.0 * 5.0 + 1e-9);
}

TEST(Polygon, InsetKeepsWhatIsFarEnoughFromEveryEdge) {
  const Polygon square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  EXPECT_NEAR(signed_area_m2(inset(square, 0.25)), 1.5 * 1.5, 1e-12);
  EXPECT_TRUE(inset(square, 1.01).empty());
}

TEST(Polygon, ACornerWithinRoundingOfAnEdgeTouchesIt) {
  // The third corner is on the first edge but for rounding: 0.1 * 3 is not 0.3.
  const double y = 0.1 * 3.0 - 0.3;
  EXPECT_TRUE(find_crossing({{0, 0}, {100, 0}, {100, 50}, {50, y}, {0, 50}}));
  EXPECT_FALSE(find_crossing({{0, 0}, {100, 0}, {100, 50}, {50, 1e-6}, {0, 50}}));
}

}  // namespace
}  // namespace vinerow::polygon_test
