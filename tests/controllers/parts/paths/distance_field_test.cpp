#include "controllers/parts/paths/distance_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/api/messages/grid.h"
#include "engine/core/random.h"

namespace vinerow::controllers::distance_field_test {
namespace {

using Vec = Eigen::Vector2d;

OccupancyGrid make_grid(int columns, int rows, double cell_m, double share, int seed) {
  OccupancyGrid grid{columns, rows, cell_m, {-3.2, 7.1}, {}};
  RandomStream random(static_cast<std::uint64_t>(seed), "grid", "cells");
  for (int i = 0; i < columns * rows; ++i) grid.cells.push_back(random.uniform() < share ? 1 : 0);
  return grid;
}

Vec centre(const OccupancyGrid& grid, int i, int j) {
  return grid.corner_W + grid.cell_m * Vec(i + 0.5, j + 0.5);
}

/// Between the centres of a cell and the nearest taken one; infinite without any.
double brute_force_m(const OccupancyGrid& grid, int i, int j) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int b = 0; b < grid.rows; ++b) {
    for (int a = 0; a < grid.columns; ++a) {
      if (grid.occupied(a, b)) nearest = std::min(nearest, grid.cell_m * std::hypot(a - i, b - j));
    }
  }
  return nearest;
}

TEST(DistanceField, EqualsBruteForceOnRandomGrids) {
  const struct {
    int columns, rows;
    double share;
  } cases[] = {{37, 23, 0.02}, {23, 37, 0.3}, {40, 40, 0.001}, {64, 3, 0.05}, {2, 2, 0.5}};
  int seed = 0;
  for (const auto& [columns, rows, share] : cases) {
    for (int repeat = 0; repeat < 4; ++repeat) {
      OccupancyGrid grid = make_grid(columns, rows, 0.05, share, ++seed);
      grid.cells[static_cast<std::size_t>(seed) % grid.cells.size()] = 1;  // at least one
      const DistanceField field(grid);
      for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
          const double expected_m = std::max(0.0, brute_force_m(grid, i, j) - 0.5 * grid.cell_m);
          ASSERT_NEAR(field.at(centre(grid, i, j)), expected_m, 1e-6) << i << " " << j;
        }
      }
    }
  }
}

TEST(DistanceField, IsBilinearBetweenCentres) {
  const OccupancyGrid grid = make_grid(20, 15, 0.1, 0.05, 9);
  const DistanceField field(grid);
  RandomStream random(1, "points", "");
  for (int n = 0; n < 500; ++n) {
    const int i = static_cast<int>(random.uniform(0, 19)),
              j = static_cast<int>(random.uniform(0, 14));
    const double u = random.uniform(), v = random.uniform();
    const double expected_m =
        (1 - v) * ((1 - u) * field.at(centre(grid, i, j)) + u * field.at(centre(grid, i + 1, j))) +
        v * ((1 - u) * field.at(centre(grid, i, j + 1)) + u * field.at(centre(grid, i + 1, j + 1)));
    ASSERT_NEAR(field.at(centre(grid, i, j) + grid.cell_m * Vec(u, v)), expected_m, 1e-6);
  }
}

TEST(DistanceField, HasNothingOutsideTheGrid) {
  const OccupancyGrid grid = make_grid(20, 10, 0.1, 0.0, 1);
  const DistanceField field(grid);
  EXPECT_TRUE(field.covers({-3.2, 7.1}));
  EXPECT_TRUE(field.covers({-1.2001, 8.0999}));
  for (const Vec& p : {Vec(-3.21, 7.5), Vec(-1.19, 7.5), Vec(-2.0, 7.09), Vec(-2.0, 8.11)}) {
    EXPECT_FALSE(field.covers(p));
    EXPECT_EQ(field.at(p), 0.0);
  }
  EXPECT_GT(field.at({-2.0, 7.5}), 1e6);  // a grid with nothing taken: far from everything
}

TEST(DistanceField, WithoutGridEverythingIsFar) {
  const DistanceField field{OccupancyGrid{}};
  EXPECT_TRUE(field.empty());
  EXPECT_EQ(field.at({1, 2}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace vinerow::controllers::distance_field_test
