/// Ground fitted to planes and waves known in closed form, below canopy, walls, holes and strays.

#include "worlds/mapping/rows/cloud_terrain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "engine/core/error.h"
#include "engine/core/random.h"

namespace vinerow::mapping::cloud_terrain_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

using Surface = std::function<double(double x, double y)>;

double plane(double x, double y) {
  return 0.1 * x - 0.05 * y;
}

/// Points of a surface, `step_m` apart over 40 m x 40 m, about (1000, 2000, 300) in W; NaN is a
/// hole.
ParcelCloud cloud_of(const Surface& surface, double step_m = 0.2) {
  ParcelCloud cloud;
  cloud.origin_W = {1000.0, 2000.0, 300.0};
  const int count = static_cast<int>(std::lround(40.0 / step_m));
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      const double x = step_m * (i + 0.5) - 20.0, y = step_m * (j + 0.5) - 20.0;
      const double z = surface(x, y);
      if (!std::isnan(z)) cloud.points.push_back(Vector3d(x, y, z).cast<float>());
    }
  }
  return cloud;
}

/// Largest error inside |x|, |y| < 15 m, where the smoothing is not one-sided.
double worst_m(const CloudTerrain& terrain, const Surface& truth) {
  double worst = 0.0;
  for (double x = -15.0; x <= 15.0; x += 0.5) {
    for (double y = -15.0; y <= 15.0; y += 0.5) {
      const double error = terrain.field.height_m(1000.0 + x, 2000.0 + y) - 300.0 - truth(x, y);
      worst = std::max(worst, std::abs(error));
    }
  }
  return worst;
}

double worst_of(const Surface& seen, const Surface& truth) {
  return worst_m(fit_terrain(cloud_of(seen), 1.0), truth);
}

TEST(CloudTerrain, APlaneIsItself) {
  // The coarse surface has steps of 0.2 m on cells of 5 m: its slope is off by up to 0.04, which is
  // 2 cm in half a cell. Bins of heights add 1 cm.
  EXPECT_LT(worst_of(plane, plane), 0.03);
  const CloudTerrain terrain = fit_terrain(cloud_of(plane), 1.0);
  EXPECT_EQ(terrain.field.columns, 41);
  EXPECT_EQ(terrain.field.rows, 41);
  EXPECT_EQ(terrain.field.corner_W, Vector2d(980.0, 1980.0));
  EXPECT_EQ(terrain.covered_m2, 41.0 * 41.0);
  EXPECT_LT(terrain.noise_m, 0.04 / std::sqrt(12.0));
}

TEST(CloudTerrain, NoiseIsThatOfThePoints) {
  RandomStream random(1, "test", "noise");
  const auto noisy = [&](double x, double y) { return plane(x, y) + 0.03 * random.normal(); };
  const CloudTerrain terrain = fit_terrain(cloud_of(noisy), 1.0);
  // 25 points in a cell.
  EXPECT_LT(worst_m(terrain, plane), 0.03);
  EXPECT_NEAR(terrain.noise_m, 0.03, 0.004);
}

TEST(CloudTerrain, CanopyAboveAFewCellsIsRemovedAndATerraceStays) {
  // 4 m are less than the opening of 5 cells, so that even half a metre is no ground. 14 m are more
  // than its 11 cells.
  const auto block = [](double half_m) {
    return [half_m](double x, double y) {
      return std::abs(x) < half_m && std::abs(y) < half_m ? 0.5 : 0.0;
    };
  };
  const auto level = [](double, double) { return 0.0; };
  EXPECT_LT(worst_of(block(2.0), level), 0.02);
  const CloudTerrain terrace = fit_terrain(cloud_of(block(7.0)), 1.0);
  EXPECT_NEAR(terrace.field.height_m(1000.0, 2000.0), 300.5, 0.02);
}

TEST(CloudTerrain, AWideHedgeIsRemovedByTheSecondOpening) {
  // Six cells, -0.5 m to 5.5 m: more than the five of the first opening. Both coarse cells below it
  // have ground.
  const auto hedge = [](double x, double y) {
    return plane(x, y) + (std::abs(x - 2.5) < 3.0 ? 2.0 : 0.0);
  };
  EXPECT_LT(worst_of(hedge, plane), 0.05);
}

TEST(CloudTerrain, HolesAreFilledFromTheirBorder) {
  const auto holed = [](double x, double y) {
    return std::hypot(x, y) < 4.0 ? std::nan("") : plane(x, y);
  };
  const CloudTerrain terrain = fit_terrain(cloud_of(holed), 1.0);
  EXPECT_LT(worst_m(terrain, plane), 0.05);
  // The hole, of 50 m2, to the cells at its border.
  EXPECT_NEAR(41.0 * 41.0 - terrain.covered_m2, 50.0, 13.0);
}

TEST(CloudTerrain, FalseMatchesBelowTheGroundAreOutvoted) {
  RandomStream random(2, "test", "strays");
  // Three in a thousand; a cell of 100 points rarely has as many as the five that decide.
  const auto seen = [&](double x, double y) {
    return plane(x, y) - (random.uniform() < 0.003 ? random.uniform(0.3, 1.2) : 0.0);
  };
  EXPECT_LT(worst_m(fit_terrain(cloud_of(seen, 0.1), 1.0), plane), 0.05);
}

TEST(CloudTerrain, GroundBelowAClosedCanopyIsItsLowestPeak) {
  // Every fourth point reaches the ground, the others the leaves.
  int k = 0;
  const auto seen = [&](double x, double y) { return plane(x, y) + (k++ % 4 == 0 ? 0.0 : 1.5); };
  EXPECT_LT(worst_of(seen, plane), 0.03);
}

std::string refusal_of(const ParcelCloud& cloud, double cell_m) {
  try {
    fit_terrain(cloud, cell_m);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "none";
}

TEST(CloudTerrain, CloudsTooSparseOrTooLargeAreRefused) {
  ParcelCloud two;
  two.points = {{0.0f, 0.0f, 0.0f}, {300.0f, 300.0f, 0.0f}};
  EXPECT_NE(refusal_of(two, 1.0).find("less than one in 4 m2"), std::string::npos);
  two.points = {{0.0f, 0.0f, 0.0f}, {90.0f, 90.0f, 0.0f}};  // below a hectare
  EXPECT_EQ(refusal_of(two, 1.0), "none");
  EXPECT_NE(refusal_of(two, 0.01).find("too large for a terrain of 0.01 m cells"),
            std::string::npos);
}

TEST(HeightAbove, InterpolatesOnTheTwoTrianglesOfACell) {
  HeightField field;
  field.columns = field.rows = 2;
  field.cell_m = 2.0;
  field.corner_W = {100.0, 200.0};
  field.heights_m = {10.0f, 11.0f, 14.0f, 12.0f};  // (0, 0), (1, 0), (0, 1), (1, 1)
  const HeightAbove above(field, Vector3d(100.0, 200.0, 20.0));
  // x > y: 10 + u 1 + v (12 - 11); x < y: 10 + v 4 + u (12 - 14).
  EXPECT_NEAR(above({1.5f, 0.5f, 1.0f}), 21.0 - (10.0 + 0.75 + 0.25), 1e-6);
  EXPECT_NEAR(above({0.5f, 1.5f, 1.0f}), 21.0 - (10.0 + 3.0 - 0.5), 1e-6);
  // Outside the field: its border.
  EXPECT_NEAR(above({9.0f, 0.0f, 0.0f}), 20.0 - 11.0, 1e-6);
}

}  // namespace
}  // namespace vinerow::mapping::cloud_terrain_test
