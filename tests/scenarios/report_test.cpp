/// `vinerow report` as a user meets it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/scenarios/command.h"

namespace vinerow::test::report_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A rover's run of some seconds with turns, without pictures.
const std::string kShort =
    scenario_file("orchard_rover") + " --set duration_s=70 --no-pictures --no-report --quiet";

/// Parses the page by programs of others and compares its numbers with summary.json.
void check_page(const std::filesystem::path& run) {
  const std::string command = "python3 " VINEROW_SOURCE_DIR "/tests/scenarios/check_report.py " +
                              (run / "report.html").string() + " " +
                              (run / "summary.json").string();
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

/// The page without what depends on the machine.
std::string without_timings(const std::string& page) {
  const std::size_t begin = page.find("<section id=\"timings\">");
  EXPECT_NE(begin, std::string::npos);
  return page.substr(0, begin) + page.substr(page.find("</section>", begin));
}

TEST(ReportCommand, MakesOnePageOfARun) {
  const ScratchFolder folder("report_run");
  const auto run = folder.path() / "run", again = folder.path() / "again";
  run_vinerow("run " + kShort + " --out " + run.string());
  const CommandResult result = run_vinerow("report " + run.string());
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("report.html"));
  check_page(run);
  const std::string page = read_text(run / "report.html");
  for (const char* part :
       {"Orchard rover", "Paper B's orchard mission", "Failed: ", "Lateral distance from the plan",
        "The first turn", "Control actions: wheel speeds", "Timings", "</a>, eq. 8",
        "S. Martelli, F. Mocera, A. Somà", "lookahead_m: 0.75"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }

  // The same bytes of the same run, and of the same scenario run again but for the timings.
  const auto copy = folder.path() / "copy.html";
  ASSERT_EQ(run_vinerow("report " + run.string() + " --out " + copy.string()).status, 0);
  EXPECT_EQ(read_text(copy), page);
  run_vinerow("run " + kShort + " --out " + again.string());
  ASSERT_EQ(run_vinerow("report " + again.string()).status, 0);
  EXPECT_EQ(without_timings(read_text(again / "report.html")), without_timings(page));
}

TEST(ReportCommand, SaysThatARunWithoutLogHasNoPlots) {
  const ScratchFolder folder("report_no_log");
  const std::string run = (folder.path() / "run").string();
  run_vinerow("run " + kShort + " --no-log --out " + run);
  const CommandResult result = run_vinerow("report " + run);
  ASSERT_EQ(result.status, 0) << result.output;
  check_page(run);
  const std::string page = read_text(folder.path() / "run/report.html");
  EXPECT_THAT(page, HasSubstr("The run wrote no log, so there are no plots."));
  EXPECT_THAT(page, Not(HasSubstr("Lateral distance from the plan")));
}

TEST(ReportCommand, TellsThePhasesOfAMission) {
  const ScratchFolder folder("report_phases");
  folder.file("summary.json", R"({
    "scenario": "small_mission", "status": "a criterion failed", "exit_status": 1, "seed": 1, "digest": "00",
    "finished": false, "simulated_s": 300.0, "criteria": [], "metrics": {"plane": {"distance_m": 1500.5}},
    "phases": [
      {"name": "survey", "kind": "vehicles", "vehicles": ["plane"], "after": [], "state": "succeeded", "begin_s": 0.0,
       "end_s": 120.5, "reason": "", "criteria": [{"name": "a", "metric": "plane.crashed", "kind": "max", "value": 0.0,
       "limit": 0.0, "met": true}]},
      {"name": "build_map", "kind": "job", "job": "cloud_map", "after": ["survey"], "state": "failed", "begin_s": 120.5,
       "end_s": 121.5, "reason": "found 3 rows <of 4>", "numbers": {"rows": 3, "points": 12345},
       "criteria": [{"name": "b", "metric": "rows", "kind": "min", "value": 3.0, "limit": 4.0, "met": false}]},
      {"name": "work", "kind": "vehicles", "vehicles": ["rover", "drone"], "after": ["build_map"], "state": "blocked",
       "begin_s": null, "end_s": null, "reason": "waits for build_map, which failed", "criteria": []}]})");
  const CommandResult result = run_vinerow("report " + folder.path().string());
  ASSERT_EQ(result.status, 0) << result.output;
  check_page(folder.path());
  const std::string page = read_text(folder.path() / "report.html");
  EXPECT_THAT(page, HasSubstr("Failed in phase build_map"));
  EXPECT_THAT(page, HasSubstr("Phase build_map failed: found 3 rows &lt;of 4&gt;"));
  EXPECT_THAT(page, HasSubstr("phase work could not start: waits for build_map, which failed"));
  EXPECT_THAT(page, HasSubstr("<strong>work</strong></td><td>rover, drone</td><td>build_map</td>"));
  EXPECT_THAT(page, HasSubstr("class=\"bar met\""));
  EXPECT_THAT(page, HasSubstr("class=\"bar failed\""));
}

TEST(ReportCommand, ShowsTheMapThatAJobMade) {
  const ScratchFolder folder("report_map");
  const auto run = folder.path() / "run";
  // As far as the map; of the frames the first alone, small.
  run_vinerow("run " + scenario_file("cooperative_small") + " --set duration_s=298 --quiet" +
              " --set pictures.width=64 --set pictures.height=64 --out " + run.string());
  const std::string page = read_text(run / "report.html");
  for (const char* picture : {"top.png", "classes.png", "mesh.png", "grid.png"}) {
    EXPECT_GT(std::filesystem::file_size(run / "products/build_map" / picture), 10'000u) << picture;
  }
  EXPECT_THAT(page, HasSubstr("The point cloud, coloured by class (build_map)"));
}

TEST(ReportCommand, RefusesInASentence) {
  const ScratchFolder folder("report_refused");
  const auto refused = [&](const std::string& arguments) {
    const CommandResult result = run_vinerow("report " + arguments);
    EXPECT_EQ(result.status, 2) << result.output;
    return result.output;
  };
  const std::string here = folder.path().string();
  EXPECT_THAT(refused(here + "/nowhere"), HasSubstr("nowhere: is not a folder"));
  EXPECT_THAT(refused(here),
              HasSubstr("contains no summary.json, so it is not the folder of a run"));
  folder.file("summary.json", "{\"scenario\": ");
  EXPECT_THAT(refused(here), HasSubstr("summary.json: is not JSON"));
  folder.file("summary.json", "{\"scenario\": 3}");
  EXPECT_THAT(refused(here), HasSubstr("summary.json: has no text 'scenario'"));

  const auto run = folder.path() / "run";
  run_vinerow("run " + kShort + " --set duration_s=1 --out " + run.string());
  folder.file("run/summary.json",
              R"({"scenario": "vineyard_rover", "status": "?", "digest": "0", "seed": 1})");
  EXPECT_THAT(
      refused(run.string()),
      HasSubstr("log.mcap: belongs to scenario 'orchard_rover' (seed 1), but summary.json next to "
                "it to 'vineyard_rover' (seed 1)"));
  std::filesystem::remove(run / "log.mcap");
  EXPECT_THAT(
      refused(run.string()),
      HasSubstr("scenario.resolved.yaml: is scenario 'orchard_rover', but summary.json next to it "
                "belongs to 'vineyard_rover'"));
  folder.file("run/summary.json",
              R"({"scenario": "orchard_rover", "status": "?", "digest": "0", "seed": 1})");
  EXPECT_THAT(refused(run.string() + " --out " + here + "/no/where.html"),
              HasSubstr("where.html' cannot be written"));
}

}  // namespace
}  // namespace vinerow::test::report_test
