/// The command `vinerow grid`, and boxes in a vehicle's way.

#include <gtest/gtest.h>

#include "engine/imaging/png.h"
#include "engine/io/grids/ros_map.h"
#include "tests/scenarios/command.h"

namespace vinerow::grid_test {
namespace {

using test::run_vinerow;
using test::ScratchFolder;

std::string block(const std::string& more) {
  return "vinerow: 1\nname: block\nduration_s: 15\nstop_when_finished: false\n"
         "world: {type: vineyard, row_count: 5, row_length_m: 30, relief_m: 0, waves_m: 0, "
         "leaf_cards_per_m: 10" +
         more +
         "}\nvehicles:\n  rover:\n    type: diff_drive_rover\n    spawn: {alley: 0, offset_m: 2}\n"
         "    planner: {type: coverage}\n    controller: {type: path_follower}\n";
}

TEST(GridCommand, WritesMapAndPictureAndTellsWhatIsOnIt) {
  const ScratchFolder folder("grid");
  const std::string out = (folder.path() / "maps" / "new").string();
  const auto result = run_vinerow("grid " + folder.file("s.yaml", block("")) + " --out " + out);
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("rows           5\n"), std::string::npos) << result.output;
  EXPECT_EQ(test::value_in(result.output, "virtual walls"), "5");
  EXPECT_EQ(test::value_in(result.output, "turning areas").substr(0, 15), "3, 5.000 m wide");
  const OccupancyGrid grid = io::load_ros_map(out + "/map.yaml").grid;
  EXPECT_EQ(test::value_in(result.output, "cells").substr(0, 10),
            std::to_string(grid.columns) + " x " + std::to_string(grid.rows));
  const auto picture = imaging::read_png(out + "/grid.png");
  ASSERT_TRUE(picture);
  // Rows are green, walls blue, turning areas yellow: each colour has its share.
  int green = 0, blue = 0, yellow = 0;
  for (int y = 0; y < picture->height; ++y) {
    for (int x = 0; x < picture->width; ++x) {
      const std::uint8_t* p = picture->at(x, y);
      green += p[1] > p[0] + 40 && p[1] > p[2] + 40;
      blue += p[2] > p[0] + 100;
      yellow += p[0] > 220 && p[1] > 200 && p[2] < 160;
    }
  }
  // 5 rows of 0.55 m by 30 m, 3 areas of 5 m by 10 m, in a picture of about 30 pixels a metre.
  EXPECT_NEAR(green / static_cast<double>(yellow), 5 * 0.55 * 30.55 / (3 * 5.0 * 10.0), 0.1);
  EXPECT_GT(blue, 5 * 10 * 30 * 2);
}

TEST(GridCommand, SetsOverrideAndTheMapReadsBackAsAWorldsMap) {
  const ScratchFolder folder("grid_set");
  const std::string scenario = folder.file("s.yaml", block(""));
  const std::string out = (folder.path() / "a").string(), again = (folder.path() / "b").string();
  auto result = run_vinerow("grid " + scenario + " --out " + out +
                            " --set world.occupancy_cell_m=0.2 --set world.virtual_walls=false");
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(test::value_in(result.output, "virtual walls"), "0");
  result = run_vinerow("grid " + scenario + " --out " + again +
                       " --set world.occupancy_file=" + out + "/map.yaml");
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(test::read_text(out + "/map.pgm"), test::read_text(again + "/map.pgm"));
  EXPECT_EQ(test::read_text(out + "/map.yaml"), test::read_text(again + "/map.yaml"));
}

TEST(GridCommand, RefusesInOneSentence) {
  const ScratchFolder folder("grid_faults");
  const std::string scenario = folder.file("s.yaml", block(""));
  const std::string start =
      "grid " + scenario + " --out " + (folder.path() / "out").string() + " --set ";
  const auto expect_refused = [&](const std::string& arguments, const std::string& text) {
    const auto result = run_vinerow(arguments);
    EXPECT_EQ(result.status, 2) << result.output;
    EXPECT_NE(result.output.find(text), std::string::npos) << "wanted: " << text << "\n"
                                                           << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  };
  expect_refused(start + "world.occupancy_cell_m=0",
                 "s.yaml: world 'vineyard' has no occupancy grid (no rows, or occupancy_cell_m = "
                 "0)");
  expect_refused(start + "world.occupancy_cell_m=-1", "occupancy_cell_m = -1 m, must be >= 0 m");
  expect_refused(start + "world.occupancy_file=none.yaml", "none.yaml");
  expect_refused(start + "world.first_wall=lst", "did you mean 'last'?");
  expect_refused(start + "'world.obstacles=[{name: box, alley: 7}]'",
                 "world.obstacles: 'box' is in alley 7, the world has 4 alleys (0 to 3)");
  folder.file("turned.yaml",
              "image: turned.pgm\nresolution: 0.1\norigin: [0, 0, 1.57]\nnegate: 0\n"
              "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  expect_refused(
      start + "world.occupancy_file=turned.yaml",
      "turned.yaml:3: origin's yaw = 1.57 rad, must be 0: rotated maps are not supported");
  expect_refused("grid " + scenario + " --out /proc/none/maps", "folder '/proc/none/maps'");
}

TEST(Obstacles, ABoxInTheAlleyStopsARoverThatDoesNotLook) {
  const ScratchFolder folder("box");
  const std::string box = ", obstacles: [{name: crate, alley: 0, distance_m: 8}]";
  // From 2 m before the alley to the crate's near side at 7.7 m, less the rover's front half.
  const std::string criteria =
      "criteria:\n  - {metric: rover.distance_m, min: 8.0, max: 9.7}\n"
      "  - {metric: rover.contact_count, min: 1, max: 1}\n";
  const auto result = run_vinerow("run " + folder.file("s.yaml", block(box) + criteria) +
                                  " --quiet --no-log --out " + folder.path().string());
  EXPECT_EQ(result.status, 0) << result.output;
  const auto without = run_vinerow("run " + folder.file("s.yaml", block("") + criteria) +
                                   " --quiet --no-log --out " + folder.path().string());
  EXPECT_EQ(without.status, 1) << without.output;
}

}  // namespace
}  // namespace vinerow::grid_test
