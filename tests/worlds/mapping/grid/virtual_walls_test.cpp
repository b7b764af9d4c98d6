#include "worlds/mapping/grid/virtual_walls.h"

#include <gtest/gtest.h>

#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/worlds/mapping/grid_search.h"

namespace vinerow::mapping::virtual_walls_test {
namespace {

using Eigen::Vector2d;

/// Walks along the ray in small steps to the first change between inside and outside.
std::optional<double> walked_hit_m(const Vector2d& from, const Vector2d& direction,
                                   const std::vector<Vector2d>& polygon, double step_m) {
  const auto inside = [&](double s_m) {
    const Vector2d p = from + s_m * direction;
    double winding = 0.0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vector2d a = polygon[k] - p, b = polygon[(k + 1) % polygon.size()] - p;
      winding += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    }
    return std::abs(winding) > kPi;
  };
  const bool at_start = inside(0.0);
  for (double s_m = step_m; s_m < 60.0; s_m += step_m) {
    if (inside(s_m) == at_start) continue;
    double low = s_m - step_m, high = s_m;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (inside(middle) == at_start ? low : high) = middle;
    }
    return high;
  }
  return std::nullopt;
}

TEST(VirtualWalls, NearestForwardHitIsThatOfABruteForceWalkInStarPolygons) {
  RandomStream random(11, "", "stars");
  int hits = 0, thin = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Vector2d> star;
    const int corners = 5 + round % 10;
    for (int k = 0; k < corners; ++k) {
      const double r = random.uniform(2.0, 20.0), a = 2.0 * kPi * (k + 0.3) / corners;
      star.push_back({r * std::cos(a), r * std::sin(a)});
    }
    const double a = random.uniform(-kPi, kPi);
    const Vector2d from(random.uniform(-6, 6), random.uniform(-6, 6)), d(std::cos(a), std::sin(a));
    const auto hit = nearest_forward_hit(from, d, star);
    const auto walked = walked_hit_m(from, d, star, 0.002);
    ASSERT_EQ(hit.has_value(), walked.has_value()) << round;
    if (!hit) continue;
    const double t_m = d.dot(*hit - from);
    EXPECT_GT(t_m, 0.0);
    // The walk steps over spikes that are thinner than its step.
    if (std::abs(t_m - *walked) > 1e-6) {
      ++thin;
      EXPECT_LT(t_m, *walked);
    }
    ++hits;
  }
  EXPECT_GT(hits, 200);
  EXPECT_EQ(thin, 0);
}

TEST(VirtualWalls, HitsAreAheadOnlyAndNearestFirst) {
  // A bay: from (1, 1) eastward the boundary comes at x = 4, again at 6 and 10.
  const std::vector<Vector2d> bay = {{0, 0},   {10, 0}, {10, 2}, {6, 2}, {6, 0.5},
                                     {4, 0.5}, {4, 2},  {10, 4}, {0, 4}};
  const auto x_of = [&](double x, double y, double dx) {
    const auto hit = nearest_forward_hit({x, y}, {dx, 0}, bay);
    return hit ? hit->x() : -1.0;
  };
  EXPECT_EQ(x_of(1, 1, 1), 4.0);
  EXPECT_EQ(x_of(1, 1, -1), 0.0);
  EXPECT_EQ(x_of(7, 1, 1), 10.0);
  EXPECT_EQ(x_of(7, 1, -1), 6.0);
  EXPECT_EQ(x_of(4, 1, 1), 6.0) << "a start on an edge is no hit";
  EXPECT_EQ(x_of(11, 1, 1), -1.0);
  EXPECT_EQ(x_of(1, 2, 1), 4.0) << "through a corner";
  EXPECT_EQ(x_of(5, 0.5, 1), 6.0) << "along an edge, to its end";
}

TEST(VirtualWalls, EndsAlternateAndWallsReachTheBoundary) {
  const RowMap map = test::straight_map(4, 30.0, 2.5, 8.0);
  std::vector<std::string> notes;
  const auto walls = make_virtual_walls(map, first_wall_of(map), notes);
  ASSERT_EQ(walls.size(), 4u);
  EXPECT_TRUE(notes.empty());
  for (int k = 0; k < 4; ++k) {
    const VirtualWall& wall = walls[static_cast<std::size_t>(k)];
    EXPECT_EQ(wall.row, k);
    EXPECT_EQ(wall.end, k % 2 == 0 ? RowEnd::kLast : RowEnd::kFirst);
    EXPECT_EQ(wall.from_W, Vector2d(k % 2 == 0 ? 30.0 : 0.0, 2.5 * k));
    EXPECT_LT((wall.to_W - Vector2d(k % 2 == 0 ? 38.0 : -8.0, 2.5 * k)).norm(), 1e-12);
  }
  const auto flipped = make_virtual_walls(map, RowEnd::kFirst, notes);
  EXPECT_EQ(flipped[0].end, RowEnd::kFirst);
  EXPECT_EQ(flipped[1].end, RowEnd::kLast);
}

TEST(VirtualWalls, FollowTheTangentOfACurvedRow) {
  RowMap map = test::straight_map(1, 10.0, 2.5, 8.0);
  map.rows[0].line_W = {{0, 0, 0}, {8, 0, 0}, {10, 1, 0}};
  map.boundary_W = {{-5, -5}, {20, -5}, {20, 9}, {-5, 9}};
  std::vector<std::string> notes;
  const auto walls = make_virtual_walls(map, RowEnd::kLast, notes);
  ASSERT_EQ(walls.size(), 1u);
  // From (10, 1) with slope 1/2 to x = 20.
  EXPECT_LT((walls[0].to_W - Vector2d(20, 6)).norm(), 1e-12);
}

TEST(VirtualWalls, ARowThatEndsOutsideTheParcelIsNamed) {
  RowMap map = test::straight_map(3, 30.0, 2.5, 8.0);
  map.boundary_W = {{-8, -3}, {20, -3}, {20, 8}, {-8, 8}};
  std::vector<std::string> notes;
  const auto walls = make_virtual_walls(map, RowEnd::kLast, notes);
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_EQ(walls[0].row, 1);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0],
            "row 0 has no virtual wall: its last point (30.00, 0.00) m is not inside the parcel's "
            "boundary");
  EXPECT_NE(notes[1].find("row 2 has no virtual wall: its last point (30.00, 5.00) m"),
            std::string::npos);
}

double signed_area_m2(const std::vector<Vector2d>& polygon) {
  double twice = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

TEST(TurningAreas, AreTwoSpacingsWideAndAsDeepAsTheHeadland) {
  for (const double bearing : {0.0, 0.4, 2.5, -2.0}) {
    const RowMap map = test::straight_map(5, 30.0, 2.5, 8.0, 0.55, bearing);
    std::vector<std::string> notes;
    const auto walls = make_virtual_walls(map, first_wall_of(map), notes);
    const auto areas = make_turning_areas(map, walls);
    ASSERT_EQ(areas.size(), 3u) << "rows 1, 2, 3";
    for (const TurningArea& area : areas) {
      EXPECT_EQ(area.end, area.row % 2 == 0 ? RowEnd::kFirst : RowEnd::kLast);
      EXPECT_NEAR(area.width_m, 5.0, 1e-9);
      EXPECT_NEAR(signed_area_m2(area.polygon_W), 5.0 * 8.0, 1e-6);
    }
  }
}

TEST(TurningAreas, OfOuterRowsReachToTheBoundaryWhereAlleysLieOutside) {
  RowMap map = test::straight_map(3, 30.0, 2.5, 8.0);
  // As in an orchard: an alley before row 0 and one behind row 2.
  map.alleys.insert(map.alleys.begin(), Alley{0, {{0, -1.25, 0}, {30, -1.25, 0}}, 2.5});
  map.alleys.push_back(Alley{3, {{0, 6.25, 0}, {30, 6.25, 0}}, 2.5});
  EXPECT_EQ(first_wall_of(map), RowEnd::kFirst);
  std::vector<std::string> notes;
  const auto areas = make_turning_areas(map, make_virtual_walls(map, RowEnd::kFirst, notes));
  ASSERT_EQ(areas.size(), 3u);
  for (const TurningArea& area : areas) {
    EXPECT_NEAR(area.width_m, 5.0, 1e-5);
    EXPECT_NEAR(signed_area_m2(area.polygon_W), 40.0, 1e-4);
  }
}

TEST(TurningAreas, TakeTheBoundarysCornersWithThem) {
  // A pointed headland: the area between rows 0 and 2 ends in the tip.
  RowMap map = test::straight_map(3, 30.0, 2.5, 8.0);
  map.boundary_W = {{-8, -2.5}, {38, -2.5}, {48, 2.5}, {38, 7.5}, {-8, 7.5}};
  std::vector<std::string> notes;
  const auto areas = make_turning_areas(map, make_virtual_walls(map, RowEnd::kLast, notes));
  ASSERT_EQ(areas.size(), 1u);
  EXPECT_NEAR(areas[0].width_m, 5.0, 1e-9);
  // Half width 2.5 m: from x = 30 to 43 (at y = 0 and 5) and to 48 (at y = 2.5).
  EXPECT_NEAR(signed_area_m2(areas[0].polygon_W), 5.0 * 13.0 + 0.5 * 5.0 * 5.0, 1e-9);
}

}  // namespace
}  // namespace vinerow::mapping::virtual_walls_test
