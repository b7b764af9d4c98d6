#include "worlds/mapping/grid/rasterise.h"

#include <gtest/gtest.h>

#include <numeric>

#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/worlds/mapping/grid_search.h"
#include "worlds/mapping/grid/virtual_walls.h"

namespace vinerow::mapping::rasterise_test {
namespace {

using Eigen::Vector2d;

OccupancyGrid empty_grid(double cell_m = 1.0, double size_m = 20.0) {
  return make_grid_over({Vector2d(0, 0), Vector2d(size_m, size_m)}, cell_m, 0);
}

double area_m2(const OccupancyGrid& grid) {
  return grid.cell_m * grid.cell_m * std::accumulate(grid.cells.begin(), grid.cells.end(), 0);
}

TEST(Rasterise, GridLinesLieOnMultiplesOfTheCellAndTheBoxHasARim) {
  const OccupancyGrid grid = make_grid_over({Vector2d(-3.2, 1.1), Vector2d(7.9, 4.0)}, 0.5, 1);
  EXPECT_EQ(grid.corner_W, Vector2d(-4.0, 0.5));
  // Up to one whole cell beyond the cell that holds the upper corner: x to 8.5, y to 5.
  EXPECT_EQ(grid.columns, 25);
  EXPECT_EQ(grid.rows, 9);
  EXPECT_EQ(cell_count({Vector2d(-3.2, 1.1), Vector2d(7.9, 4.0)}, 0.5), 25.0 * 9.0);
  EXPECT_EQ(std::accumulate(grid.cells.begin(), grid.cells.end(), 0), 25 * 9);
}

TEST(Rasterise, PolygonTakesTheCellsWhoseCentreIsInside) {
  // Against the centre's own test, for random star polygons, also beyond the grid.
  RandomStream random(5, "", "polygons");
  for (int round = 0; round < 50; ++round) {
    std::vector<Vector2d> star;
    const int corners = 3 + round % 9;
    for (int k = 0; k < corners; ++k) {
      const double r = random.uniform(1.0, 14.0), a = 2.0 * kPi * k / corners;
      star.push_back({10.0 + r * std::cos(a), 10.0 + r * std::sin(a)});
    }
    OccupancyGrid grid = empty_grid(0.37);
    fill_polygon(grid, star, 1);
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const Vector2d centre = grid.corner_W + grid.cell_m * Vector2d(i + 0.5, j + 0.5);
        // Winding of angles: another rule than the product's, equal for simple polygons.
        double winding = 0.0;
        for (std::size_t k = 0; k < star.size(); ++k) {
          const Vector2d a = star[k] - centre, b = star[(k + 1) % star.size()] - centre;
          winding += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
        }
        ASSERT_EQ(grid.occupied(i, j), std::abs(winding) > kPi) << round << ": " << i << ", " << j;
      }
    }
  }
}

TEST(Rasterise, PolygonAreaIsUnbiased) {
  // A turned rectangle of 0.55 m by 15 m at 400 offsets: the mean area is the rectangle's.
  RandomStream random(6, "", "offsets");
  double sum = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double a = random.uniform(0.0, kPi);
    const Vector2d x(std::cos(a), std::sin(a)), y(-x.y(), x.x());
    const Vector2d c(10.0 + random.uniform(0, 0.1), 10.0 + random.uniform(0, 0.1));
    OccupancyGrid grid = empty_grid(0.1);
    fill_polygon(grid,
                 {c - 7.5 * x - 0.275 * y, c + 7.5 * x - 0.275 * y, c + 7.5 * x + 0.275 * y,
                  c - 7.5 * x + 0.275 * y},
                 1);
    sum += area_m2(grid);
  }
  EXPECT_NEAR(sum / 400.0, 0.55 * 15.0, 0.003 * 0.55 * 15.0);
}

/// Whether the closed square of a cell and a segment have a point in common (separating axes).
bool touches(const Vector2d& low, double size, const Vector2d& a, const Vector2d& b, double eps) {
  const Vector2d d = b - a;
  for (const Vector2d& axis : {Vector2d(1, 0), Vector2d(0, 1), Vector2d(-d.y(), d.x())}) {
    if (axis.norm() == 0.0) continue;
    const Vector2d n = axis.normalized();
    const double half = 0.5 * size * (std::abs(n.x()) + std::abs(n.y()));
    const double c = n.dot(low + Vector2d(0.5 * size, 0.5 * size));
    const double s0 = n.dot(a), s1 = n.dot(b);
    if (std::min(s0, s1) > c + half + eps || std::max(s0, s1) < c - half - eps) return false;
  }
  return true;
}

TEST(Rasterise, SegmentTakesEveryCellItTouchesAndNoOther) {
  RandomStream random(7, "", "segments");
  for (int round = 0; round < 200; ++round) {
    // Every other segment has whole coordinates: lines along edges and through corners.
    const auto coordinate = [&] {
      const double v = random.uniform(-3.0, 23.0);
      return round % 2 == 0 ? std::round(v) : v;
    };
    const Vector2d a(coordinate(), coordinate()), b(coordinate(), coordinate());
    OccupancyGrid grid = empty_grid();
    mark_segment(grid, a, b, 1);
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const Vector2d low = grid.corner_W + Vector2d(i, j);
        if (touches(low, 1.0, a, b, -1e-9)) {
          ASSERT_TRUE(grid.occupied(i, j)) << round << ": " << i << ", " << j;
        } else if (!touches(low, 1.0, a, b, 1e-5)) {
          ASSERT_FALSE(grid.occupied(i, j)) << round << ": " << i << ", " << j;
        }
      }
    }
  }
}

TEST(Rasterise, NoWayLeadsAcrossASegment) {
  for (int k = 0; k < 90; ++k) {
    const double a = kPi * k / 90.0;
    const Vector2d d(std::cos(a), std::sin(a)), n(-d.y(), d.x()), c(10.0, 10.0);
    OccupancyGrid grid = empty_grid(0.5);
    mark_segment(grid, c - 40.0 * d, c + 40.0 * d, 1);
    EXPECT_FALSE(std::isfinite(test::path_length_m(grid, c - 3.0 * n, c + 3.0 * n))) << k;
  }
}

}  // namespace
}  // namespace vinerow::mapping::rasterise_test
