/// The replay of a short run: its page must have the contents of its log.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/api/world_model.h"
#include "engine/record/log_reader.h"
#include "tests/scenarios/command.h"
#include "tests/tools/replay_page.h"
#include "tools/parts/register_all.h"
#include "tools/replay/replay_run.h"

namespace vinerow::tools::replay_run_test {
namespace {

using nlohmann::json;
using test::ReplayPage;
using test::run_vinerow;
using test::ScratchFolder;

/// Runs the quadrotor over a small vineyard for `span_s`.
void run_into(const ScratchFolder& folder, double span_s, const std::string& more = "") {
  const auto result =
      run_vinerow("run " + test::scenario_file("vineyard_quadrotor_two_rows") +
                  " --no-pictures --quiet --set duration_s=" + std::to_string(span_s) +
                  " --set criteria=[] --set world.row_count=4 --set world.row_length_m=30 " + more +
                  " --out " + (folder.path() / "run").string());
  ASSERT_EQ(result.status, 0) << result.output;
}

std::string replay_of(const ScratchFolder& folder, const std::string& name) {
  const auto out = folder.path() / name;
  const auto result =
      run_vinerow("replay " + (folder.path() / "run").string() + " --out " + out.string());
  EXPECT_EQ(result.status, 0) << result.output;
  return test::read_text(out);
}

/// Without three.js the program makes no replays.
class WithThree : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_replay()) GTEST_SKIP() << replay_absence();
  }
};
using ReplayRunPage = WithThree;
using ReplaySection = WithThree;
using ReplayCommand = WithThree;

Registry all_parts() {
  Registry registry;
  register_all(registry);
  return registry;
}

ReplayRun read_run(const ScratchFolder& folder) {
  return read_replay_run(folder.path() / "run", all_parts());
}

Eigen::Quaterniond rotation_at(const std::vector<std::int16_t>& values, std::size_t i) {
  return Eigen::Quaterniond(values[4 * i + 3], values[4 * i], values[4 * i + 1], values[4 * i + 2])
      .normalized();
}

TEST_F(ReplayRunPage, HoldsThePosesOfTheLog) {
  const ScratchFolder folder("replay_poses");
  run_into(folder, 12.0);
  const ReplayPage page(replay_of(folder, "replay.html"));
  const ReplayRun run = read_run(folder);
  const playback::VehicleTrace& trace = run.trace.vehicles.at("drone");
  ASSERT_EQ(page.index["vehicles"].size(), 1u);
  const json& vehicle = page.index["vehicles"][0];
  EXPECT_EQ(vehicle["name"], "drone");
  const auto n = vehicle["samples"].get<std::size_t>();
  ASSERT_GT(n, 40u);
  const auto times = page.numbers<std::uint32_t>(vehicle["times"], n);
  const auto positions = page.numbers<std::int32_t>(vehicle["positions"], 3 * n);
  const auto rotations = page.numbers<std::int16_t>(vehicle["rotations"], 4 * n);
  // Half a millimetre in each of three axes; half a step of 1/32767 in each of four components
  // turns by at most twice their norm.
  const double max_m = 0.5e-3 * std::sqrt(3.0) + 1e-9, max_rad = 2.0 * 2.0 * 0.5 / 32767.0;
  std::set<std::uint32_t> known;
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_TRUE(known.insert(times[i]).second);
    const Odometry truth = trace.truth_at(run.trace.first + duration_from_s(1e-3 * times[i]));
    const Eigen::Vector3d p(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    EXPECT_LE((1e-3 * p - truth.X_WB.p).norm(), max_m);
    EXPECT_LE(rotation_at(rotations, i).angularDistance(truth.X_WB.q), max_rad);
  }
  EXPECT_EQ(*known.begin(), 0u);
  EXPECT_NEAR(1e-3 * *known.rbegin(), page.index["duration_s"].get<double>(), 1e-3);

  // Between samples a page goes straight: at 10 a second that is within a few millimetres.
  double farthest_m = 0.0;
  for (const Time t : trace.truth.times) {
    const double t_ms = 1e3 * (t - run.trace.first).s();
    const std::size_t b = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t_ms) -
                                 times.begin()),
        1, n - 1);
    const double share = std::clamp((t_ms - times[b - 1]) / (times[b] - times[b - 1]), 0.0, 1.0);
    Eigen::Vector3d p;
    for (int c = 0; c < 3; ++c) {
      p[c] = 1e-3 * (positions[3 * (b - 1) + c] +
                     share * (positions[3 * b + c] - positions[3 * (b - 1) + c]));
    }
    farthest_m = std::max(farthest_m, (p - trace.truth_at(t).X_WB.p).norm());
  }
  EXPECT_LE(farthest_m, 0.02);

  const auto heights = page.numbers<float>(vehicle["heights"], n);
  for (std::size_t i = 0; i < n; ++i) {
    const double ground_m =
        run.world->terrain->height_m(1e-3 * positions[3 * i], 1e-3 * positions[3 * i + 1]);
    EXPECT_NEAR(heights[i], 1e-3 * positions[3 * i + 2] - ground_m, 2e-3);
  }

  // The body does not move against itself; rotors spin faster than samples can resolve.
  ASSERT_EQ(vehicle["links"].size(), run.vehicles[0]->links().size());
  EXPECT_FALSE(vehicle["links"][0].contains("rotations"));
  for (std::size_t l = 1; l < vehicle["links"].size(); ++l) {
    const json& rotor = vehicle["links"][l];
    EXPECT_EQ(rotor["axis"], json({0.0, 0.0, 1.0})) << rotor;
    const auto spins = page.numbers<std::uint8_t>(rotor["spins"], n);
    EXPECT_EQ(spins[n / 2], 1) << rotor;
  }
}

TEST_F(ReplayRunPage, HoldsThePosesOfWheels) {
  const ScratchFolder folder("replay_wheels");
  const auto result = run_vinerow(
      "run " + test::scenario_file("vineyard_4ws_two_rows") +
      " --no-pictures --quiet --set duration_s=14 --set criteria=[] --set world.row_count=4 --set "
      "world.row_length_m=30 --out " +
      (folder.path() / "run").string());
  ASSERT_EQ(result.status, 0) << result.output;
  const ReplayPage page(replay_of(folder, "replay.html"));
  const ReplayRun run = read_run(folder);
  const playback::VehicleTrace& trace = run.trace.vehicles.at("rover");
  const json& vehicle = page.index["vehicles"][0];
  const auto n = vehicle["samples"].get<std::size_t>();
  const auto times = page.numbers<std::uint32_t>(vehicle["times"], n);
  int turning = 0;
  for (std::size_t l = 0; l < vehicle["links"].size(); ++l) {
    const json& link = vehicle["links"][l];
    EXPECT_FALSE(link.contains("axis")) << link;
    if (!link.contains("rotations")) continue;
    ++turning;
    const auto rotations = page.numbers<std::int16_t>(link["rotations"], 4 * n);
    for (std::size_t i = 0; i < n; ++i) {
      const Time t = run.trace.first + duration_from_s(1e-3 * times[i]);
      const Eigen::Quaterniond q_BL = trace.truth_at(t).X_WB.q.conjugate() * trace.links_at(t)[l].q;
      EXPECT_LE(rotation_at(rotations, i).angularDistance(q_BL), 2.0 / 32767.0);
    }
  }
  EXPECT_GE(turning, 4);
}

TEST_F(ReplayRunPage, IsTheSameTwiceAndRefersToNothingOutside) {
  const ScratchFolder folder("replay_same");
  run_into(folder, 3.0);
  const std::string page = replay_of(folder, "a.html");
  EXPECT_TRUE(page == replay_of(folder, "b.html"));
  EXPECT_LT(page.size(), 12'000'000u);
  // Outside of scripts nothing loads anything; the scripts are ours and three.js, and what a
  // browser asks for is watched by the test with one.
  std::string markup;
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t begin = std::min(page.find("<script", at), page.size());
    markup += page.substr(at, begin - at);
    const std::size_t end = page.find("</script>", begin);
    if (begin < page.size()) {
      const std::string tag = page.substr(begin, page.find('>', begin) - begin);
      EXPECT_EQ(tag.find("src"), std::string::npos) << tag;
    }
    at = end == std::string::npos ? page.size() : end + 9;
  }
  for (const char* loader : {"src=", "href=", "url(", "@import", "<link", "<iframe"}) {
    EXPECT_EQ(markup.find(loader), std::string::npos) << loader;
  }
  EXPECT_NE(page.find("Permission is hereby granted, free of charge"), std::string::npos);
  EXPECT_NE(page.find("three.js authors"), std::string::npos);
}

TEST_F(ReplayRunPage, ShowsTheWorldAndTheVehiclesLinks) {
  const ScratchFolder folder("replay_scene");
  run_into(folder, 2.0);
  const ReplayPage page(replay_of(folder, "replay.html"));
  const ReplayRun run = read_run(folder);
  const json gltf = test::gltf_of(page.scene);
  std::set<std::string> parts, surfaces, links;
  std::set<int> groups;
  Eigen::AlignedBox3d terrain_W;
  for (const json& node : gltf["nodes"]) {
    if (!node.contains("extras")) continue;
    const json& extras = node["extras"];
    parts.insert(extras["part"].get<std::string>());
    if (extras.contains("surface")) surfaces.insert(extras["surface"].get<std::string>());
    if (extras.contains("group")) groups.insert(extras["group"].get<int>());
    if (extras["part"] == "link") links.insert(node["name"].get<std::string>());
  }
  EXPECT_EQ(parts, (std::set<std::string>{"link", "surroundings", "terrain", "world"}));
  for (const char* surface : {"canopy", "post", "trunk"}) EXPECT_TRUE(surfaces.contains(surface));
  EXPECT_EQ(links.size(), run.vehicles[0]->links().size());
  // Four rows of 30 m in chunks of about 7 m.
  EXPECT_GE(groups.size(), 12u);
  EXPECT_EQ(page.index["ground"]["rows"].size(), 4u);
  EXPECT_TRUE(page.index["notes"].is_array());
}

TEST_F(ReplaySection, TellsWhatItLeavesOut) {
  const ScratchFolder folder("replay_left_out");
  run_into(folder, 2.0, "--set 'world.neighbours={count: 8}' --set world.surroundings_m=70");
  ReplayRun run = read_run(folder);

  ReplayLimits tight;
  tight.leaf_bytes = tight.solid_bytes = 30'000;
  tight.terrain_samples = 400;
  tight.track_bytes = 60;
  tight.plan_points = 3;
  const std::string small = replay_section(run.input(), tight), whole = replay_section(run.input());
  const json notes = ReplayPage(small).index["notes"];
  const auto has_note = [&](const std::string& words) {
    for (const json& note : notes) {
      if (note.get<std::string>().find(words) != std::string::npos) return true;
    }
    return false;
  };
  EXPECT_TRUE(has_note("the ground has a point every")) << notes;
  EXPECT_TRUE(has_note("leaves near the camera are fewer")) << notes;
  EXPECT_TRUE(has_note("meshes are simplified: details smaller than")) << notes;
  EXPECT_TRUE(has_note("times a second, with straight motion between")) << notes;
  EXPECT_TRUE(has_note("plans are not shown")) << notes;
  EXPECT_TRUE(has_note("around the parcel are shown in the pictures only")) << notes;
  const std::size_t small_scene = ReplayPage(small).scene.size(),
                    whole_scene = ReplayPage(whole).scene.size();
  EXPECT_LT(2 * small_scene, whole_scene);

  run.trace.vehicles.at("drone") = {};
  const ReplayPage without_truth(replay_section(run.input()));
  EXPECT_TRUE(without_truth.index["vehicles"].empty());
  EXPECT_EQ(without_truth.index["notes"].back(),
            "'drone' is not shown: the log has no true poses of it");

  run.vehicles.clear();
  run.scenario.vehicles.clear();
  const ReplayPage without_vehicles(replay_section(run.input()));
  EXPECT_EQ(without_vehicles.index["notes"].back(), "the run has no vehicles");
}

TEST_F(ReplaySection, PosesCenturiesApartAreNotFilledIn) {
  const ScratchFolder folder("replay_centuries");
  run_into(folder, 2.0);
  ReplayRun run = read_run(folder);
  // False stamps: the last pose 280 years after the others.
  playback::VehicleTrace& drone = run.trace.vehicles.at("drone");
  const Time far = run.trace.first + duration_from_s(280.0 * 365.25 * 86400.0);
  drone.truth.times.back() = drone.links.times.back() = run.trace.last = far;
  const ReplayPage page(replay_section(run.input()));
  const json& vehicle = page.index["vehicles"][0];
  const auto n = vehicle["samples"].get<std::size_t>();
  EXPECT_LE(n, drone.truth.times.size());
  const auto times = page.numbers<std::uint32_t>(vehicle["times"], n);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  EXPECT_EQ(times.back(), std::numeric_limits<std::uint32_t>::max());  // 49.7 days, all it can hold
}

TEST_F(ReplaySection, KeepsTextFromEndingItsElement) {
  const ScratchFolder folder("replay_names");
  run_into(folder, 1.0);
  ReplayRun run = read_run(folder);
  run.scenario.name = "a</script><b>&\"";
  run.phases = {{"<!--<script>", 0.0, 1.0, "succeeded"}};
  const std::string page = replay_page(run.input());
  EXPECT_EQ(page.find("a</script>"), std::string::npos);
  EXPECT_EQ(page.find("<!--<script>"), std::string::npos);
  const ReplayPage read(page);
  EXPECT_EQ(read.index["name"], run.scenario.name);
  EXPECT_EQ(read.index["phases"][0]["name"], "<!--<script>");
}

TEST_F(ReplayCommand, TakesALogOfTheCurrentFolder) {
  const ScratchFolder folder("replay_here");
  run_into(folder, 0.5);
  const auto result = run_vinerow("replay log.mcap --out here.html",
                                  "cd " + (folder.path() / "run").string() + " &&");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "run" / "here.html"));
}

TEST_F(ReplayCommand, RefusesWhatIsNoRun) {
  const ScratchFolder folder("replay_refused");
  const auto refused = [&](const std::string& run, const std::string& sentence) {
    const auto result = run_vinerow("replay " + run);
    EXPECT_EQ(result.status, 2) << result.output;
    EXPECT_NE(result.output.find(sentence), std::string::npos) << result.output;
  };
  refused(folder.path().string(), "contains no log.mcap, so there is nothing to replay");
  refused(folder.file("log.mcap", "no log"), "log.mcap: not an MCAP file");
  refused((folder.path() / "nowhere").string(), "nowhere");
}

}  // namespace
}  // namespace vinerow::tools::replay_run_test
