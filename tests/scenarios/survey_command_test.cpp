/// The command `vinerow survey`.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/api/height_field.h"
#include "engine/imaging/png.h"
#include "engine/io/geo/height_raster.h"
#include "engine/io/missions/mission_file.h"
#include "engine/math/angles.h"
#include "tests/scenarios/command.h"
#include "tests/support/data.h"
#include "tests/support/paths.h"

namespace vinerow::survey_command_test {
namespace {

using test::run_vinerow;
using test::ScratchFolder;
using test::value_in;

const std::string kField = "x,y\n0,0\n260,0\n260,405\n0,405\n";

void expect_refused(const std::string& arguments, const std::string& text) {
  const auto result = run_vinerow(arguments);
  EXPECT_EQ(result.status, 2) << result.output;
  EXPECT_NE(result.output.find(text), std::string::npos) << "wanted: " << text << "\n"
                                                         << result.output;
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
}

TEST(SurveyCommand, PlansAPolygonAndWritesMissionsWaypointsAndAPicture) {
  const ScratchFolder folder("survey");
  const std::string out = (folder.path() / "a" / "b").string();
  const auto result = run_vinerow("survey --polygon " + folder.file("field.csv", kField) +
                                  " --origin 44.7,8.03,300 --lane_bearing_deg 90 --out " + out);
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(value_in(result.output, "lanes"), "10, 45.0 m apart, bearing 90.0 deg");
  EXPECT_EQ(value_in(result.output, "GSD"),
            "104.2 mm at 150.0 m; 104.2 to 104.2 mm at the lowest and highest points of the lanes");
  EXPECT_EQ(value_in(result.output, "order"),
            "lanes 9, 8, 7, 6, 5, 4, 3, 2, 1, 0 (numbers as in waypoints.csv)");

  const io::MissionFile plan = io::read_mission(out + "/survey.plan");
  const io::MissionFile text = io::read_mission(out + "/survey.waypoints");
  ASSERT_EQ(plan.items.size(), text.items.size());
  ASSERT_TRUE(plan.planned_home);
  EXPECT_NEAR(plan.planned_home->altitude_m, 300.0, 1e-6);
  EXPECT_NEAR(deg_from_rad(text.planned_home->latitude_rad), 44.7, 1e-8);
  EXPECT_EQ(plan.items.front().command, 22);
  EXPECT_EQ(plan.items.back().command, 20);
  int places = 0, switched_on = 0;
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    EXPECT_EQ(plan.items[i].command, text.items[i].command);
    EXPECT_NEAR(plan.items[i].params[4], text.items[i].params[4], 1e-8);
    places += plan.items[i].command == 16 || plan.items[i].command == 22;
    switched_on += plan.items[i].command == 206 && plan.items[i].params[0] > 0.0;
  }
  EXPECT_EQ(switched_on, 10);

  // A line of the table for each waypoint: start and home are no items.
  const std::string table = test::read_text(out + "/waypoints.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + places + 2);
  EXPECT_EQ(table.find("waypoint,kind,lane,x_m,y_m,z_m,above_ground_m,latitude_deg"), 0u);

  // The picture has lanes from violet to green, and the orange footprint of a picture.
  const auto picture = imaging::read_png(out + "/survey.png");
  ASSERT_TRUE(picture);
  int violet = 0, green = 0, orange = 0;
  for (int y = 0; y < picture->height; ++y) {
    for (int x = 0; x < picture->width; ++x) {
      const std::uint8_t* p = picture->at(x, y);
      violet += p[0] > 50 && p[0] < 80 && p[1] < 20 && p[2] > 60 && p[2] < 110;
      green += p[1] > p[0] + 40 && p[1] > p[2] + 60;
      orange += p[0] > 190 && p[1] < 110 && p[2] < 60;
    }
  }
  EXPECT_GT(violet, 1000);
  EXPECT_GT(green, 1000);
  EXPECT_GT(orange, 1000);
}

TEST(SurveyCommand, PlansTheSurveyOfAScenarioAsARunDoes) {
  const ScratchFolder folder("survey_scenario");
  const std::string scenario = folder.file(
      "s.yaml",
      "vinerow: 1\nname: field\nduration_s: 1\nstop_when_finished: false\n"
      "world: {type: vineyard, row_count: 4, row_length_m: 60, surroundings_m: 300, "
      "terrain_cell_m: 2}\n"
      "vehicles:\n  plane:\n    include: " +
          std::string(VINEROW_SOURCE_DIR) +
          "/assets/vehicles/mh900_like.yaml\n    spawn: {x_m: -60, y_m: -60, yaw_deg: 180}\n"
          "    planner: {type: survey, margin_m: 60, height_m: 125}\n");
  const auto result =
      run_vinerow("survey " + scenario + " --out " + (folder.path() / "out").string());
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("100.00 % covered"), std::string::npos) << result.output;
  const auto run =
      run_vinerow("run " + scenario + " --no-log --out " + (folder.path() / "run").string());
  const std::string summary = test::read_text(folder.path() / "run" / "summary.json");
  EXPECT_NE(summary.find("\"covered_share\": 1.0"), std::string::npos) << run.output;
  const std::string waypoints = value_in(result.output, "waypoints").substr(0, 2);
  EXPECT_NE(summary.find("\"waypoints\": " + waypoints + ".0"), std::string::npos) << waypoints;

  expect_refused("survey " + scenario + " --vehicle jet", "there is no vehicle 'jet'");
  // The stall speed comes from the vehicle's description.
  expect_refused("survey " + scenario + " --set plane.planner.height_m=59",
                 "at most 5.9 m/s at 59 m (below the stall speed of 8.");
  expect_refused("survey " + scenario + " --polygon x.csv", "give either a scenario or --polygon");
}

TEST(SurveyCommand, RefusesInOneSentence) {
  const ScratchFolder folder("survey_faults");
  const std::string field = folder.file("field.csv", kField);
  const std::string start = "survey --origin 44.7,8.03 --polygon " + field + " ";
  expect_refused(start + "--gsd_m 0.041 --stall_speed_mps 8.4",
                 "it needs at most 5.9 m/s at 59 m (below the stall speed of 8.4 m/s), or a camera "
                 "with 2.04 Hz, or at least 120 m for 12.0 m/s (GSD 83 mm)");
  expect_refused(start + "--speed_mps fast", "--speed_mps: 'fast' is not a number");
  expect_refused(start + "--side_overlap 1.2", "side_overlap = 1.2, must be");
  expect_refused(start + "--camera leica", "camera = 'leica'");
  expect_refused(start + "--out /proc/none/out", "folder '/proc/none/out' cannot be created");
  expect_refused("survey --polygon " + field, "give the position of its (0, 0) with --origin");
  expect_refused("survey --polygon none.csv --origin 44,8", "'none.csv' does not exist");
  expect_refused("survey", "give either a scenario or --polygon");
  expect_refused(
      "survey --origin 44,8 --polygon " + folder.file("bow.csv", "0,0\n100,100\n100,0\n0,100\n"),
      "its edge from point 1 (0.0, 0.0) to point 2 (100.0, 100.0) crosses its edge from "
      "point 3");
  expect_refused("survey --origin 44,8 --polygon " + folder.file("two.csv", "0,0\n1,1\n"),
                 "it has 2 different points, needs at least 3");
  expect_refused(start + "--heading nan", "--heading: must be finite");
  expect_refused(start + "--start nan,0", "--start: must be finite");
  expect_refused(start + "--image_columns 1280.5", "'1280.5' is not a whole number");
  // What would change nothing.
  for (const char* option : {"--set a=b", "--seed 3", "--plugin none.so", "--vehicle plane"}) {
    expect_refused(start + option, std::string(option).substr(0, std::string(option).find(' ')) +
                                       " has no effect without a scenario");
  }
  expect_refused(start + "--crs EPSG:32632", "--crs has no effect without --dem");
  for (const char* option : {"--origin 44,8", "--dem none.tif", "--start 0,0", "--heading 90"}) {
    expect_refused(std::string("survey s.yaml ") + option,
                   std::string(option).substr(0, std::string(option).find(' ')) +
                       " has no effect without --polygon");
  }
  expect_refused("survey --log none --pictures --height_m 60",
                 "--height_m has no effect with --log");
}

TEST(SurveyCommand, SaysWhereLatitudeAndLongitudeAreSwapped) {
  const ScratchFolder folder("survey_swapped");
  HeightField field;
  field.columns = field.rows = 61;
  field.cell_m = 20.0;
  field.corner_W = {-400.0, -400.0};
  field.heights_m.assign(61u * 61u, 2.0f);
  const std::filesystem::path dem = folder.path() / "dem.tif";
  io::write_height_raster(field, GeoOrigin{rad_from_deg(44.7), rad_from_deg(8.03), 300.0}, dem);
  const auto field_of = [&](const std::string& name, const std::string& ring) {
    return folder.file(name, R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon",)"
                             R"("coordinates":[[)" +
                                 ring + "]]}}");
  };
  const std::string start = "survey --dem " + dem.string() + " --height_m 80 --speed_mps 5 --out " +
                            (folder.path() / "out").string() + " --polygon ";
  const auto right = run_vinerow(
      start + field_of("right.geojson",
                       "[8.03,44.7],[8.033,44.7],[8.033,44.702],[8.03,44.702],[8.03,44.7]"));
  EXPECT_EQ(right.status, 0) << right.output;
  expect_refused(
      start + field_of("swapped.geojson",
                       "[44.7,8.03],[44.7,8.033],[44.702,8.033],[44.702,8.03],[44.7,8.03]"),
      "at latitude 8.030000 deg, longitude 44.700000 deg is outside the terrain of '" +
          dem.string() + "'; are latitude and longitude swapped?");
}

TEST(SurveyCommand, SurveysMountainsAndRefusesWhatTheirModelDoesNotHold) {
  VINEROW_OUTSIDE_DATA(folder_of_dem, "terrain_navigation");
  std::filesystem::path dem;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_of_dem)) {
    if (entry.path().filename() == "davosdorf.tif") dem = entry.path();
  }
  const ScratchFolder folder("survey_dem");
  const std::string start =
      "survey --dem " + dem.string() + " --crs EPSG:21781 --origin 46.8182,9.8278 ";
  const std::string out = " --out " + (folder.path() / "out").string();
  const auto result =
      run_vinerow(start + "--height_m 200 --max_slope 0.3 --start -600,0 --polygon " +
                  folder.file("field.csv", "0,0\n400,0\n400,500\n0,500\n") + out);
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("100.00 % covered"), std::string::npos) << result.output;
  expect_refused(start + "--height_m 200 --polygon " +
                     folder.file("far.csv", "0,0\n40000,0\n40000,500\n0,500\n") + out,
                 "point 2 of the polygon at (40000.0, 0.0) is outside the terrain");
}

}  // namespace
}  // namespace vinerow::survey_command_test
