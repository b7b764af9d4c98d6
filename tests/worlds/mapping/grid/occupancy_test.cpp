#include "worlds/mapping/grid/occupancy.h"

#include <gtest/gtest.h>

#include <chrono>

#include "engine/core/error.h"
#include "tests/worlds/mapping/grid_search.h"
#include "worlds/mapping/grid/rasterise.h"

namespace vinerow::mapping::occupancy_test {
namespace {

using Eigen::Vector2d;
using test::occupied_at;
using test::path_length_m;
using test::straight_map;

OccupancyOptions with_cell(double cell_m) {
  OccupancyOptions options;
  options.cell_m = cell_m;
  return options;
}

TEST(Occupancy, RowsBoundaryAndOutsideAreTakenTheRestIsFree) {
  RowMap map = straight_map(2, 20.0, 2.5, 8.0, 0.6);
  OccupancyOptions options = with_cell(0.05);
  options.virtual_walls = false;
  const OccupancyGrid grid = make_occupancy_grid(map, options);
  EXPECT_TRUE(occupied_at(grid, {10.0, 0.28}));
  EXPECT_FALSE(occupied_at(grid, {10.0, 0.33}));
  EXPECT_TRUE(occupied_at(grid, {19.97, 0.0}));
  EXPECT_FALSE(occupied_at(grid, {20.03, 0.0})) << "square ends at the row's end";
  EXPECT_FALSE(occupied_at(grid, {10.0, 1.25}));
  EXPECT_FALSE(occupied_at(grid, {27.9, 4.0}));
  EXPECT_TRUE(occupied_at(grid, {28.01, 4.0}));
  EXPECT_TRUE(occupied_at(grid, {10.0, -2.51}));
  EXPECT_TRUE(occupied_at(grid, {-30.0, 0.0})) << "beyond the grid";
  options.row_end_margin_m = 0.3;
  EXPECT_TRUE(occupied_at(make_occupancy_grid(map, options), {20.28, 0.0}));
}

TEST(Occupancy, FreeAreaIsParcelLessRows) {
  // Rows of 0.6 x 20 m in a parcel of 36 x 7.5 m; the boundary's cells cost half a cell inside.
  const RowMap map = straight_map(2, 20.0, 2.5, 8.0, 0.6, 0.3);
  OccupancyOptions options = with_cell(0.02);
  options.virtual_walls = false;
  const OccupancyGrid grid = make_occupancy_grid(map, options);
  const double free_m2 = free_share(grid) * 0.0004 * static_cast<double>(grid.cells.size());
  EXPECT_NEAR(free_m2, 36.0 * 7.5 - 2 * 0.6 * 20.0, 0.02 * 87.0);
}

TEST(Occupancy, BentRowsAreStripsWithoutGaps) {
  RowMap map = straight_map(1, 20.0, 10.0, 8.0, 1.0);
  map.rows[0].line_W = {{0, 0, 0}, {10, 0, 0}, {17, 7, 0}};
  OccupancyOptions options = with_cell(0.02);
  options.virtual_walls = false;
  const OccupancyGrid grid = make_occupancy_grid(map, options);
  // The mitre of a bend by 45 deg to the left: outer corner at half width * tan(22.5 deg) beyond
  // it.
  EXPECT_TRUE(occupied_at(grid, {10.0 + 0.5 * std::tan(0.3927) - 0.04, -0.47}));
  EXPECT_FALSE(occupied_at(grid, {10.0 + 0.5 * std::tan(0.3927) + 0.04, -0.47}));
  double occupied_m2 = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const Vector2d p = grid.corner_W + 0.02 * Vector2d(i + 0.5, j + 0.5);
      if (p.x() > -5 && p.x() < 25 && p.y() > -5 && p.y() < 9) {
        occupied_m2 += 0.0004 * grid.occupied(i, j);
      }
    }
  }
  // A mitred strip has the area of width times the length of its centre line.
  EXPECT_NEAR(occupied_m2, 1.0 * (10.0 + std::hypot(7.0, 7.0)), 0.05);
}

TEST(Occupancy, ObstaclesOnTheMapAreTaken) {
  const RowMap map = straight_map(2, 20.0, 2.5, 8.0);
  OccupancyOptions options = with_cell(0.05);
  options.obstacles_W = {{{9, 1}, {10, 1}, {10, 1.5}, {9, 1.5}}};
  EXPECT_TRUE(occupied_at(make_occupancy_grid(map, options), {9.5, 1.25}));
  EXPECT_FALSE(occupied_at(make_occupancy_grid(map, with_cell(0.05)), {9.5, 1.25}));
}

/// A parcel as large as Parcel F, along x.
const RowMap& large_map() {
  static const RowMap map = straight_map(16, 118.0, 2.5, 10.0);
  return map;
}

const Vector2d kStart(0.0, 1.25), kGoal(118.0, 14.5 * 2.5);

TEST(Occupancy, TheShortestFreeWayIsTheSerpentine) {
  const OccupancyGrid walled = make_occupancy_grid(large_map(), with_cell(0.1));
  const double geodesic_m = path_length_m(walled, kStart, kGoal);
  // 15 alleys, and 14 turns that may hug the row ends. A serpentine over the centre lines is
  // longer.
  const double serpentine_m = 15 * 118.0 + 14 * 2.5;
  EXPECT_GE(geodesic_m, 15 * 118.0);
  EXPECT_LE(geodesic_m, serpentine_m);
  OccupancyOptions open = with_cell(0.1);
  open.virtual_walls = false;
  const double shortcut_m = path_length_m(make_occupancy_grid(large_map(), open), kStart, kGoal);
  EXPECT_LT(shortcut_m, 118.0 + 14 * 2.5 + 1.0);
  RecordProperty("geodesic_m", std::to_string(geodesic_m));
  RecordProperty("without_walls_m", std::to_string(shortcut_m));
}

TEST(Occupancy, EveryAlleyIsTheOnlyWay) {
  // In any direction of the grid: a plug in any alley cuts start and goal apart.
  for (const double bearing : {0.0, 0.17, 0.7853981633974483, 1.3, 3.0}) {
    const RowMap map = straight_map(6, 20.0, 2.5, 8.0, 0.55, bearing);
    const Eigen::Rotation2Dd turn(bearing);
    const Vector2d start = turn * Vector2d(0, 1.25), goal = turn * Vector2d(20.0, 4.5 * 2.5);
    const OccupancyGrid grid = make_occupancy_grid(map, with_cell(0.1));
    EXPECT_TRUE(std::isfinite(path_length_m(grid, start, goal)));
    for (int alley = 0; alley < 5; ++alley) {
      OccupancyGrid plugged = grid;
      mark_segment(plugged, turn * Vector2d(10.0, 2.5 * alley),
                   turn * Vector2d(10.0, 2.5 * alley + 2.5), 1);
      EXPECT_FALSE(std::isfinite(path_length_m(plugged, start, goal)))
          << bearing << ", alley " << alley;
    }
  }
}

TEST(Occupancy, TheOtherOrderOpensTheOtherSerpentine) {
  const RowMap map = straight_map(4, 20.0, 2.5, 8.0);
  OccupancyOptions options = with_cell(0.1);
  options.first_wall = RowEnd::kFirst;
  const OccupancyGrid grid = make_occupancy_grid(map, options);
  // From alley 0's last point backwards.
  EXPECT_NEAR(path_length_m(grid, {20.0, 1.25}, {0.0, 6.25}), 3 * 20.0 + 2 * 1.0, 2.0);
  EXPECT_LT(path_length_m(grid, {0.0, 1.25}, {0.0, 3.75}), 4.0) << "open at the first point";
}

TEST(Occupancy, WallsEndAtTheFirstBoundaryInABay) {
  // A bay of the boundary reaches between rows 1 and 3: row 2's wall ends at the bay.
  RowMap map = straight_map(5, 30.0, 2.5, 8.0);
  map.boundary_W = {{-8, -3}, {38, -3}, {38, 3}, {33, 4}, {33, 6}, {38, 7}, {38, 13}, {-8, 13}};
  const OccupancyReport report = plan_occupancy(map, with_cell(0.05));
  ASSERT_EQ(report.walls.size(), 5u);
  EXPECT_LT((report.walls[2].to_W - Vector2d(33, 5)).norm(), 1e-12);
  const OccupancyGrid grid = make_occupancy_grid(map, with_cell(0.05), report);
  EXPECT_TRUE(occupied_at(grid, {35.0, 5.0})) << "in the bay";
  EXPECT_TRUE(occupied_at(grid, {32.0, 5.0})) << "the wall";
  EXPECT_FALSE(occupied_at(grid, {32.0, 4.0}));
}

TEST(Occupancy, FiveMillionCellsAreQuick) {
  const RowMap map = straight_map(40, 150.0, 2.5, 10.0, 0.55, 0.3);
  const OccupancyOptions options = with_cell(0.08);
  const auto begin = std::chrono::steady_clock::now();
  const OccupancyGrid grid = make_occupancy_grid(map, options);
  const double ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  RecordProperty("cells", std::to_string(grid.cells.size()));
  RecordProperty("ms", std::to_string(ms));
  EXPECT_GT(grid.cells.size(), 3'500'000u);
#ifdef NDEBUG
  EXPECT_LT(ms, 100.0);
#endif
}

TEST(Occupancy, TooManyCellsAndNoBoundaryAreRefused) {
  RowMap map = straight_map(2, 20.0, 2.5, 8.0);
  OccupancyOptions options = with_cell(0.01);
  options.cell_limit = 1'000'000;
  const auto error_of = [&] {
    try {
      make_occupancy_grid(map, options);
    } catch (const ConfigError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error_of(),
            "occupancy cells of 0.01 m make 2.71 million cells of a parcel of 36 x 8 m, must be at "
            "most 1 million: use cells of at least 0.017 m");
  options.cell_m = cell_that_fits_m(map.boundary_W, options.cell_m, options.cell_limit);
  EXPECT_LE(make_occupancy_grid(map, options).cells.size(), 1'000'000u);
  EXPECT_EQ(cell_that_fits_m(map.boundary_W, 0.05, 1'000'000), 0.05);
  map.boundary_W.clear();
  EXPECT_EQ(error_of(),
            "an occupancy grid needs the parcel's boundary with at least 3 corners, it has 0");
}

}  // namespace
}  // namespace vinerow::mapping::occupancy_test
