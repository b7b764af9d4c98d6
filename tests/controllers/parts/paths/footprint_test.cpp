#include "controllers/parts/paths/footprint.h"

#include <gtest/gtest.h>

#include "engine/api/messages/grid.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/swept_check.h"

namespace vinerow::test::footprint_test {
namespace {

using Vec = Eigen::Vector2d;

const std::vector<Vec> kOutline_B = {{0.95, -0.36}, {0.95, 0.36},   {0.75, 0.5},   {-0.75, 0.5},
                                     {-0.95, 0.36}, {-0.95, -0.36}, {-0.75, -0.5}, {0.75, -0.5}};
constexpr double kCell_m = 0.05;

/// 8 x 8 m with some boxes and single cells.
OccupancyGrid make_grid(int seed) {
  OccupancyGrid grid{160, 160, kCell_m, {-4, -4}, std::vector<std::uint8_t>(160 * 160, 0)};
  RandomStream random(static_cast<std::uint64_t>(seed), "grid", "boxes");
  for (int n = 0; n < 6; ++n) {
    const int i = static_cast<int>(random.uniform(0, 150)),
              j = static_cast<int>(random.uniform(0, 150));
    const int size = n < 3 ? 1 : 10;
    for (int b = j; b < j + size; ++b) {
      for (int a = i; a < i + size; ++a) grid.cells[static_cast<std::size_t>(b) * 160 + a] = 1;
    }
  }
  return grid;
}

controllers::Pose2 draw_pose(RandomStream& random) {
  const double x = random.uniform(-2.8, 2.8), y = random.uniform(-2.8, 2.8);
  return {{x, y}, random.uniform(-kPi, kPi)};
}

TEST(Footprint, ClearanceIsExactToACell) {
  int overlaps = 0, near = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    const OccupancyGrid grid = make_grid(seed);
    const controllers::DistanceField field(grid);
    const controllers::Footprint footprint(field, kOutline_B, 0.05);
    RandomStream random(static_cast<std::uint64_t>(seed), "poses", "");
    for (int n = 0; n < 100; ++n) {
      const controllers::Pose2 pose = draw_pose(random);
      const double exact_m = distance_to_cells(kOutline_B, pose, grid, 2.0);
      const double clearance_m = footprint.clearance_m(pose);
      if (exact_m >= 2.0) continue;  // farther than was looked
      ASSERT_NEAR(clearance_m, exact_m, kCell_m) << seed << " " << n;
      overlaps += exact_m == 0.0;
      near += exact_m > 0.0 && exact_m < 0.2;
    }
  }
  EXPECT_GT(overlaps, 100);
  EXPECT_GT(near, 50);
}

TEST(Footprint, NeverCallsAnOverlapFreeNorAWidePoseTaken) {
  for (const double margin_m : {0.0, 0.05, 0.2}) {
    int free = 0, blocked = 0;
    for (int seed = 1; seed <= 10; ++seed) {
      const OccupancyGrid grid = make_grid(100 + seed);
      const controllers::DistanceField field(grid);
      const controllers::Footprint footprint(field, kOutline_B, margin_m);
      RandomStream random(static_cast<std::uint64_t>(seed), "poses", "");
      for (int n = 0; n < 200; ++n) {
        const controllers::Pose2 pose = draw_pose(random);
        const double exact_m = distance_to_cells(kOutline_B, pose, grid, 1.0);
        const bool is_free = footprint.is_free(pose);
        if (is_free) {
          ASSERT_GT(exact_m, std::max(0.0, margin_m - kCell_m)) << seed << " " << n;
        } else {
          ASSERT_LT(exact_m, margin_m + kCell_m + 0.5 * kCell_m) << seed << " " << n;
        }
        (is_free ? free : blocked)++;
      }
    }
    EXPECT_GT(free, 200) << margin_m;
    EXPECT_GT(blocked, 200) << margin_m;
  }
}

TEST(Footprint, SeesWhatLiesWhollyInside) {
  OccupancyGrid grid{160, 160, kCell_m, {-4, -4}, std::vector<std::uint8_t>(160 * 160, 0)};
  grid.cells[80 * 160 + 80] = 1;  // at the origin, and nothing else
  const controllers::DistanceField field(grid);
  const controllers::Footprint footprint(field, kOutline_B, 0.0);
  for (double x = -0.9; x <= 0.9; x += 0.07) {
    for (double y = -0.45; y <= 0.45; y += 0.05) {
      if (std::abs(x) > 0.7 && std::abs(y) > 0.33) continue;  // beside the cut corners
      EXPECT_EQ(footprint.clearance_m({{x, y}, 0.0}), 0.0) << x << " " << y;
      EXPECT_FALSE(footprint.is_free({{x, y}, kPi})) << x << " " << y;
    }
  }
}

TEST(Footprint, LooksAlongTheWholeArc) {
  OccupancyGrid grid{160, 160, kCell_m, {-4, -4}, std::vector<std::uint8_t>(160 * 160, 0)};
  for (int j = 100; j < 110; ++j) grid.cells[static_cast<std::size_t>(j) * 160 + 100] = 1;
  const controllers::DistanceField field(grid);
  const controllers::Footprint footprint(field, kOutline_B, 0.05);
  const controllers::Pose2 start{{-1, 0}, 0.0};  // the box stands at (1, 1) to (1.05, 1.5)
  EXPECT_TRUE(footprint.is_free_along(start, 3.0, 0.0, 0.1));
  EXPECT_FALSE(footprint.is_free_along(start, 3.0, 0.5, 0.1));
  EXPECT_NEAR(footprint.clearance_along_m(start, 3.0, 0.0, 0.02), 0.5, kCell_m);
  EXPECT_EQ(footprint.clearance_along_m(start, 3.0, 0.5, 0.02), 0.0);
  // Backwards from the end of the same arc it is the same arc.
  const controllers::Pose2 end = controllers::advance(start, 3.0, 1.5);
  EXPECT_FALSE(footprint.is_free_along(end, -3.0, 0.5, 0.1));
}

TEST(InsetPolygon, MovesEveryEdgeInwards) {
  const std::vector<Vec> square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  const std::vector<Vec> inner = inset(square, 0.25);
  ASSERT_EQ(inner.size(), 4u);
  double area = 0.0;
  for (std::size_t i = 0; i < 4; ++i) area += 0.5 * cross(inner[i], inner[(i + 1) % 4]);
  EXPECT_NEAR(area, 2.25, 1e-12);
  EXPECT_TRUE(inset(square, 1.01).empty());
  // The octagon's cut corners vanish where the insets of its long edges meet before them.
  EXPECT_EQ(inset(kOutline_B, 0.1).size(), 8u);
}

}  // namespace
}  // namespace vinerow::test::footprint_test
