#include "engine/io/missions/mission_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/io/missions/mav_command.h"
#include "engine/io/missions/qgc_plan.h"
#include "engine/io/missions/qgc_wpl.h"
#include "engine/math/angles.h"
#include "tests/support/data.h"

namespace vinerow::io::mission_file_test {
namespace {

const std::string kSamples = "mavsdk/cpp/src/mavsdk/plugins/mission_raw/test_plans/";

std::filesystem::path write(const std::string& content, const std::string& ending = ".plan") {
  const auto file = std::filesystem::temp_directory_path() /
                    (std::string("vinerow_mission_") +
                     ::testing::UnitTest::GetInstance()->current_test_info()->name() + ending);
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

std::string error_of(const std::filesystem::path& file) {
  try {
    read_mission(file);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "no error";
}

void expect_error(const std::filesystem::path& file, const std::string& part) {
  const std::string error = error_of(file);
  EXPECT_NE(error.find(part), std::string::npos) << "wanted: " << part << "\ngot:    " << error;
  EXPECT_NE(error.find(file.filename().string()), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

std::vector<int> commands_of(const MissionFile& mission) {
  std::vector<int> commands;
  for (const MissionItem& item : mission.items) commands.push_back(item.command);
  return commands;
}

std::string item(const std::string& command, const std::string& frame = "3",
                 const std::string& params = "[0,0,0,null,47.4,8.5,50]") {
  return R"({"autoContinue":true,"command":)" + command + R"(,"doJumpId":1,"frame":)" + frame +
         R"(,"params":)" + params + R"(,"type":"SimpleItem"})";
}
std::string plan(const std::string& items, const std::string& more = "") {
  return R"({"fileType":"Plan","version":1,"groundStation":"x","mission":{"version":2,"items":[)" +
         items + R"(],"plannedHomePosition":[47.4,8.5,488.0]})" + more + "}";
}

TEST(MissionFile, ReadsThePlansThatMavsdkAccepts) {
  VINEROW_OUTSIDE_DATA(folder, kSamples);
  const MissionFile sample = read_mission(folder / "qgroundcontrol_sample.plan");
  EXPECT_EQ(commands_of(sample), (std::vector<int>{22, 16, 2000, 16, 16, 20}));
  EXPECT_EQ(sample.items[0].params[0], 15.0);
  EXPECT_TRUE(std::isnan(sample.items[0].params[3]));
  EXPECT_EQ(sample.items[3].params[4], 47.39827377);
  EXPECT_EQ(sample.items[3].frame, 3);
  EXPECT_EQ(sample.items[5].number, 6);
  ASSERT_TRUE(sample.planned_home);
  EXPECT_DOUBLE_EQ(deg_from_rad(sample.planned_home->longitude_rad), 8.5456075);
  EXPECT_EQ(sample.planned_home->altitude_m, 488.93101752001763);
  EXPECT_EQ(sample.cruise_speed_mps, 15.0);

  const MissionFile survey = read_mission(folder / "qgroundcontrol_sample_with_survey.plan");
  EXPECT_EQ(commands_of(survey),
            (std::vector<int>{530, 16, 206, 16, 206, 16, 16, 16, 16, 206, 16, 16, 206}));
  EXPECT_EQ(survey.items[1].number, 2);  // all items of the survey have the survey's number
  EXPECT_EQ(survey.items[12].number, 2);
  EXPECT_EQ(survey.items[2].params[0], 25.0);

  const MissionFile digicam =
      read_mission(folder / "qgroundcontrol_sample_with_digicam_control.plan");
  EXPECT_EQ(commands_of(digicam), (std::vector<int>{203}));

  const MissionFile text = read_mission(folder / "mission_planner_sample.txt");
  EXPECT_EQ(text.format, "QGC WPL 110");
  EXPECT_EQ(commands_of(text), (std::vector<int>{22, 16, 16, 20}));
  EXPECT_EQ(text.items[3].frame, 5);
  EXPECT_EQ(text.items[3].params[5], 8.5453247);
  EXPECT_TRUE(text.items[3].auto_continue);
  EXPECT_FALSE(text.planned_home);
}

TEST(MissionFile, RefusesThePlansThatMavsdkRefuses) {
  VINEROW_OUTSIDE_DATA(folder, kSamples);
  const std::string begin = "qgroundcontrol_sample_";
  expect_error(folder / (begin + "wrong_overall_version.plan"),
               "version 42 is not known, only version 1 is");
  expect_error(folder / (begin + "wrong_mission_version.plan"),
               "mission: version 7 is not known, only version 2 is");
  expect_error(folder / (begin + "without_mission.plan"), "'mission' is missing");
  expect_error(folder / (begin + "with_survey_wrong_version.plan"), "item 2: version");
  expect_error(folder / (begin + "with_survey_missing_items.plan"),
               "item 2, TransectStyleComplexItem: 'Items' is missing");
  expect_error(folder / (begin + "with_structured_scan.plan"),
               "item 2: complex items of type 'StructureScan' are not known, only 'survey' is");
}

TEST(MissionFile, ReadsFencesWithTheirNumbers) {
  VINEROW_OUTSIDE_DATA(file, "px4_missions/multicopter_mission_geofence_avoid.plan");
  const MissionFile mission = read_mission(file);
  EXPECT_EQ(commands_of(mission), (std::vector<int>{22, 16, 16, 16, 20}));
  ASSERT_EQ(mission.fence_circles.size(), 1u);
  EXPECT_EQ(mission.fence_circles[0].radius_m, 111.05361447891983);
  EXPECT_FALSE(mission.fence_circles[0].inclusion);
  ASSERT_EQ(mission.fence_polygons.size(), 2u);
  EXPECT_FALSE(mission.fence_polygons[0].inclusion);
  EXPECT_TRUE(mission.fence_polygons[1].inclusion);
  EXPECT_DOUBLE_EQ(deg_from_rad(mission.fence_polygons[1].points[3].longitude_rad),
                   8.53812458836515);
  EXPECT_TRUE(mission.rally_points.empty());
}

TEST(MissionFile, RefusesWhatItDoesNotKnowBySayingWhichItem) {
  expect_error(write(plan(item("16") + "," + item("4711"))),
               "item 2: command 4711 is not known; known are take-off 22, waypoints 16");
  expect_error(write(plan(item("16", "8"))), "item 1 (NAV_WAYPOINT): frame 8 is not known");
  expect_error(write(plan(item("16", "3", "[0,0,0,null,47.4,8.5]"))),
               "item 1: 'params' has 6 numbers, must be 7");
  expect_error(write(plan(item("16", "3", R"([0,0,0,"x",47.4,8.5,50])"))),
               "parameter 4 = \"x\" must be a number or null");
  expect_error(write(plan(item("16", "3", "[0,0,0,0,null,8.5,50]"))), "it has no position");
  expect_error(write(plan(item("16", "2"))), "it has no position");
  expect_error(write(plan(item("16", "3", "[0,0,0,0,47.4,8.5,null]"))), "it has no altitude");
  expect_error(write(plan(item("16", "3", "[0,0,0,0,474,8.5,50]"))), "latitude 474 deg");
  expect_error(write(plan(R"({"type":"SimpleItem","command":16})")), "'frame' is missing");
  expect_error(write(plan(R"({"type":"Odd"})")), "item 1: type 'Odd' is not known");
  expect_error(write(plan(R"({"command":16})")), "'type' is missing");
  expect_error(write(plan("7")), "item 1: it is not a JSON object");
  expect_error(write(plan(item("16.5"))), "'command' = 16.5 must be a whole number");
  expect_error(write(plan("", R"(,"geoFence":{"version":1})")), "geoFence: version 1 is not known");
  expect_error(write(plan("", R"(,"geoFence":{"version":2,"circles":[],"polygons":[
    {"inclusion":true,"polygon":[[1,2],[3,4]],"version":1}]})")),
               "polygon 1: it has 2 points, needs at least 3");
  expect_error(write(plan("", R"(,"geoFence":{"version":2,"polygons":[],"circles":[
    {"inclusion":true,"circle":{"center":[1,2],"radius":-3},"version":1}]})")),
               "'radius' = -3 must be a number > 0");
  expect_error(write("{\"fileType\":\n\"Plan\","), "is not valid JSON (line 2)");
  expect_error(write(plan(item("16", "3", "[1e999,0,0,0,47,8,50]"))), "a number that is too large");
  expect_error(write("{}"), "its 'fileType' is not 'Plan'");
  expect_error(write(""), "is empty");
  expect_error(write("hello"), "is neither a QGroundControl plan (JSON) nor a 'QGC WPL 110' text");
  expect_error("/nowhere/none.plan", "does not exist");
}

TEST(MissionFile, RefusesFaultyTexts) {
  const std::string good = "0\t1\t3\t16\t0\t0\t0\t0\t47.4\t8.5\t50\t1\n";
  const auto text = [](const std::string& lines) { return write(lines, ".waypoints"); };
  expect_error(text("QGC WPL 120\n" + good), "begins with 'QGC WPL 120', must be 'QGC WPL 110'");
  expect_error(text("QGC WPL 110\n" + good + "1\t0\t3\t16\n"),
               "item 2: it has 4 fields, must be 12");
  expect_error(text("QGC WPL 110\n0\t1\t3\t16\t0\t0\tx\t0\t47.4\t8.5\t50\t1"),
               "item 1: parameter 3 = 'x' is not a number");
  expect_error(text("QGC WPL 110\n" + good + good), "item 2: its index is 0, must be 1");
  expect_error(text("QGC WPL 110\n0\t1\t3\t999\t0\t0\t0\t0\t47.4\t8.5\t50\t1"),
               "item 1: command 999 is not known");
}

TEST(MissionFile, TextsMayHaveBlanksWindowsLinesAndHomeFirst) {
  const MissionFile mission = read_mission(write(
      "QGC WPL 110\r\n0 1 0 16 0 0 0 0 47.4 8.5 488 1\r\n1 0 3 22 15 0 0 nan 47.5 8.6 30 1\r\n"
      "\r\n2 0 10 16 0 0 0 0 47.6 8.7 40 0",
      ".waypoints"));
  ASSERT_TRUE(mission.planned_home);
  EXPECT_EQ(mission.planned_home->altitude_m, 488.0);
  EXPECT_EQ(commands_of(mission), (std::vector<int>{22, 16}));
  EXPECT_TRUE(std::isnan(mission.items[0].params[3]));
  EXPECT_EQ(mission.items[1].frame, 10);
  EXPECT_FALSE(mission.items[1].auto_continue);
}

MissionFile make_mission() {
  MissionFile mission;
  mission.planned_home = Geodetic{rad_from_deg(44.7), rad_from_deg(8.03), 312.25};
  mission.cruise_speed_mps = 12.0;
  const double nan = std::nan("");
  mission.items = {{22, 3, {15, 0, 0, nan, 44.7001, 8.0301, 150}, true, 1},
                   {16, 3, {0, 0, 0, nan, 44.70123456789, 8.03123456789, 151.234}, true, 2},
                   {206, 2, {14.8, 0, 1, 0, 0, 0, 0}, true, 3},
                   {16, 10, {0, 0, 0, nan, 44.702, 8.032, 150}, true, 4},
                   {20, 2, {0, 0, 0, 0, 0, 0, 0}, true, 5}};
  mission.fence_polygons = {{true, {{0.78, 0.14, 0}, {0.781, 0.14, 0}, {0.781, 0.141, 0}}}};
  mission.fence_circles = {{false, {0.7805, 0.1405, 0}, 55.5}};
  mission.rally_points = {{0.7805, 0.1405, 30.0}};
  return mission;
}

TEST(MissionFile, PlansComeBackAsTheyWereWritten) {
  const MissionFile wanted = make_mission();
  const auto file = write("");
  write_qgc_plan(wanted, file);
  const MissionFile found = read_mission(file);
  ASSERT_EQ(found.items.size(), wanted.items.size());
  for (std::size_t i = 0; i < wanted.items.size(); ++i) {
    EXPECT_EQ(found.items[i].command, wanted.items[i].command);
    EXPECT_EQ(found.items[i].frame, wanted.items[i].frame);
    for (std::size_t k = 0; k < 7; ++k) {
      const double a = found.items[i].params[k], b = wanted.items[i].params[k];
      EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << i << " " << k;
    }
  }
  EXPECT_NEAR(found.planned_home->latitude_rad, wanted.planned_home->latitude_rad, 1e-15);
  EXPECT_EQ(found.planned_home->altitude_m, 312.25);
  EXPECT_EQ(found.cruise_speed_mps, 12.0);
  EXPECT_NEAR(found.fence_polygons[0].points[2].longitude_rad, 0.141, 1e-15);
  EXPECT_EQ(found.fence_circles[0].radius_m, 55.5);
  EXPECT_EQ(found.rally_points[0].altitude_m, 30.0);
}

TEST(MissionFile, TextsComeBackAsTheyWereWritten) {
  const MissionFile wanted = make_mission();
  const auto file = write("", ".waypoints");
  write_qgc_wpl(wanted, file);
  const MissionFile found = read_mission(file);
  EXPECT_EQ(commands_of(found), commands_of(wanted));
  EXPECT_EQ(found.planned_home->altitude_m, 312.25);
  for (std::size_t i = 0; i < wanted.items.size(); ++i) {
    EXPECT_EQ(found.items[i].frame, wanted.items[i].frame);
    EXPECT_NEAR(found.items[i].params[4], wanted.items[i].params[4], 1e-9);  // 0.1 mm
    EXPECT_NEAR(found.items[i].params[6], wanted.items[i].params[6], 1e-3);
  }
  EXPECT_EQ(found.items[2].params[0], 14.8);
}

TEST(MissionFile, CutOffAndBrokenFilesAreRefusedOrRead) {
  const std::string plan_text = format_qgc_plan(make_mission()),
                    text = format_qgc_wpl(make_mission());
  int refused = 0;
  for (const std::string& whole : {plan_text, text}) {
    for (std::size_t at = 1; at < whole.size(); at += 41) {
      std::string broken = whole;
      broken[at] = static_cast<char>("{}[],:\"9e-x\t\n\xff"[at % 15]);
      for (const std::string& content : {whole.substr(0, at), broken}) {
        refused += error_of(write(content)) != "no error";
      }
    }
  }
  EXPECT_GT(refused, 80);
}

/// Every key with its JSON type that the sample, saved by QGroundControl itself, has at a place
/// must be there in ours.
void expect_same_shape(const nlohmann::json& sample, const nlohmann::json& ours,
                       const std::string& path) {
  for (const auto& [key, value] : sample.items()) {
    ASSERT_TRUE(ours.contains(key)) << path << "/" << key;
    const bool same_kind =
        ours[key].type() == value.type() || (ours[key].is_number() && value.is_number());
    EXPECT_TRUE(same_kind) << path << "/" << key << ": " << ours[key].type_name();
    if (value.is_object()) expect_same_shape(value, ours[key], path + "/" + key);
  }
}

TEST(MissionFile, WrittenPlansHaveWhatQGroundControlSaves) {
  VINEROW_OUTSIDE_DATA(folder, kSamples);
  std::ifstream stream(folder / "qgroundcontrol_sample.plan");
  const auto sample = nlohmann::json::parse(stream);
  const auto ours = nlohmann::json::parse(format_qgc_plan(make_mission()));
  expect_same_shape(sample, ours, "");
  EXPECT_EQ(ours["mission"]["plannedHomePosition"].size(), 3u);
  const auto& samples = sample["mission"]["items"];
  for (const auto& [id, entry] : ours["mission"]["items"].items()) {
    // A waypoint's keys are those of the sample's waypoint, a camera command's of its command 2000.
    expect_same_shape(entry["frame"] == 2 ? samples[2] : samples[1], entry, "items/" + id);
    EXPECT_EQ(entry["doJumpId"], std::stoi(id) + 1);
    EXPECT_EQ(entry["params"].size(), 7u);
  }
}

TEST(MavCommand, TableIsSortedSoThatEveryCommandIsFound) {
  int known = 0;
  for (int number = 0; number < 5000; ++number) {
    if (find_mav_command(number) != nullptr) ++known;
  }
  EXPECT_EQ(known, 55);
  for (const int number :
       {16, 17, 18, 19, 20, 21, 22, 82, 178, 201, 203, 205, 206, 530, 531, 2000, 2001}) {
    EXPECT_NE(find_mav_command(number), nullptr) << number;
  }
  EXPECT_EQ(describe_mav_command(16), "16 NAV_WAYPOINT");
  EXPECT_EQ(describe_mav_command(4711), "4711");
}

}  // namespace
}  // namespace vinerow::io::mission_file_test
