/// Output of `vinerow run` and `vinerow coverage` about a survey's pictures, as a user sees it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/scenarios/command.h"

namespace vinerow::test::coverage_test {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

/// A rover that carries a camera 6 m above itself through two alleys.
constexpr const char* kMastCamera = R"(
vinerow: 1
name: mast
seed: 1
duration_s: 60
world: {type: vineyard, row_count: 3, row_length_m: 14, relief_m: 0.5, surroundings_m: 20}
vehicles:
  rover:
    type: diff_drive_rover
    spawn: {alley: 0, offset_m: 1.0}
    sensors:
      camera: {type: camera_trigger, position_m: [0, 0, 6], distance_m: 0.5, max_rate_Hz: 5}
    planner: {type: coverage, waypoint_pitch_m: 0.25}
    controller: {type: path_follower, rate_Hz: 20, speed_mps: 1.0}
metrics: {survey: {type: survey, camera: camera, cell_m: 0.2}}
)";

Json read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  return Json::parse(in);
}
std::string read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Coverage, TheLogTellsWhatTheMetricSawAndAgainAfterwards) {
  const ScratchFolder folder("coverage");
  const std::string scenario = folder.file("mast.yaml", kMastCamera);
  const std::string out = (folder.path() / "run").string();
  const CommandResult run = run_vinerow("run " + scenario + " --quiet --out " + out);
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("coverage " + out + "/coverage.png"));
  const Json numbers = read_json(out + "/coverage.json")["numbers"];
  const Json metrics = read_json(out + "/summary.json")["metrics"]["rover"];
  EXPECT_GT(numbers["shots"], 20.0);
  EXPECT_GT(numbers["covered_twice_share"], 0.2);
  for (const auto& [name, value] : numbers.items()) {
    if (value.is_null()) {
      EXPECT_TRUE(metrics[name].is_null()) << name;
      continue;
    }
    EXPECT_NEAR(value.get<double>(), metrics[name].get<double>(), 1e-9) << name;
  }

  const std::string again = (folder.path() / "again.png").string();
  ASSERT_EQ(run_vinerow("coverage " + out + " --out " + again).status, 0);
  EXPECT_EQ(read_bytes(again), read_bytes(out + "/coverage.png"));
  EXPECT_EQ(read_bytes(folder.path() / "again.json"), read_bytes(out + "/coverage.json"));

  // A parcel under the first picture alone.
  const Json first = read_json(out + "/coverage.json")["pictures"][0]["corners_m"];
  std::string corners;
  for (const Json& corner : first) corners += " " + corner[0].dump() + " " + corner[1].dump();
  const CommandResult own = run_vinerow("coverage " + out + "/log.mcap --cell 0.1 --out " + again +
                                        " --polygon" + corners);
  ASSERT_EQ(own.status, 0) << own.output;
  EXPECT_EQ(read_json(folder.path() / "again.json")["numbers"]["covered_share"], 1.0);

  const CommandResult odd = run_vinerow("coverage " + out + " --polygon 0 0 1 0 1");
  EXPECT_EQ(odd.status, 2);
  EXPECT_THAT(odd.output, HasSubstr("--polygon: 5 numbers, must be an even number"));
  const CommandResult crossed = run_vinerow("coverage " + out + " --polygon 0 0 9 9 9 0 0 9");
  EXPECT_EQ(crossed.status, 2);
  EXPECT_THAT(crossed.output, HasSubstr("the parcel crosses itself"));
}

TEST(Coverage, ARunWithoutPicturesHasNone) {
  const ScratchFolder folder("no_coverage");
  std::string text = kMastCamera;
  const auto drop = [&text](const std::string& part) { text.erase(text.find(part), part.size()); };
  drop(
      "      camera: {type: camera_trigger, position_m: [0, 0, 6], distance_m: 0.5, max_rate_Hz: "
      "5}\n");
  drop("    sensors:\n");
  drop("metrics: {survey: {type: survey, camera: camera, cell_m: 0.2}}\n");
  const std::string out = (folder.path() / "run").string();
  const CommandResult run = run_vinerow("run " + folder.file("plain.yaml", text) +
                                        " --set duration_s=1 --quiet --out " + out);
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_FALSE(std::filesystem::exists(out + "/coverage.png"));
  const CommandResult none = run_vinerow("coverage " + out);
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.output, HasSubstr("contains no picture"));
}

}  // namespace
}  // namespace vinerow::test::coverage_test
