/// Files of a live run's page: complete, and consistent with the run.

#include "tools/live/live_page.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"
#include "tests/scenarios/command.h"
#include "tools/parts/register_all.h"
#include "tools/replay/replay.h"

namespace vinerow::tools::live_page_test {
namespace {

using nlohmann::json;

class LivePage : public ::testing::Test {
 protected:
  LivePage() { register_all(registry_); }

  void SetUp() override {
    if (!has_replay()) GTEST_SKIP() << replay_absence();
    const scenario::Overrides small{
        {"world.row_count=4", "world.row_length_m=30", "criteria=[]", "duration_s=5"}, {}};
    scenario_ = scenario::load_scenario(test::scenario_file("vineyard_quadrotor_two_rows"),
                                        registry_, small);
  }

  std::map<std::string, live::WebFile> files_of(const Simulation& simulation) const {
    std::map<std::string, live::WebFile> files;
    for (live::WebFile& file : live_page(simulation, registry_)()) {
      const std::string path = file.path;
      EXPECT_TRUE(files.emplace(path, std::move(file)).second) << path << " is there twice";
    }
    return files;
  }

  Registry registry_;
  scenario::Scenario scenario_;
};

TEST_F(LivePage, RefersToFilesThatExistAndHasNoInlineScript) {
  const Simulation simulation(scenario_, registry_);
  const auto files = files_of(simulation);
  const std::string& page = files.at("/").bytes;
  std::set<std::string> referred;
  for (const std::string attribute : {" src=\"", " href=\""}) {
    for (std::size_t at = 0; (at = page.find(attribute, at)) != std::string::npos;) {
      at += attribute.size();
      const std::string address = page.substr(at, page.find('"', at) - at);
      if (address.starts_with("data:")) continue;
      // The server puts its token there.
      ASSERT_TRUE(address.ends_with("?{{token}}")) << address;
      const std::string path = "/" + address.substr(0, address.find('?'));
      EXPECT_TRUE(files.contains(path)) << path;
      referred.insert(path);
    }
  }
  // The server's content security policy forbids inline scripts.
  for (std::size_t at = 0; (at = page.find("<script", at)) != std::string::npos; ++at) {
    EXPECT_EQ(page.substr(at, 13), "<script src=\"");
  }
  for (const auto& [path, file] : files) {
    if (path.ends_with(".js")) {
      EXPECT_TRUE(referred.contains(path)) << path << " is not used";
    }
    EXPECT_FALSE(file.media_type.empty()) << path;
    EXPECT_FALSE(file.bytes.empty()) << path;
  }
}

TEST_F(LivePage, HasTheVehiclesAtTheirPresentPoses) {
  Simulation simulation(scenario_, registry_);
  const json before = json::parse(files_of(simulation).at("/index.json").bytes);
  simulation.run_until(Time{} + duration_from_s(4.0));
  const json after = json::parse(files_of(simulation).at("/index.json").bytes);
  EXPECT_EQ(after["name"], simulation.scenario().name);
  ASSERT_EQ(after["vehicles"].size(), simulation.scenario().vehicles.size());
  const json& drone = after["vehicles"][0];
  EXPECT_EQ(drone["name"], "drone");
  EXPECT_EQ(drone["flies"], true);
  const Odometry& truth = simulation.truth("drone");
  // The truth is of the last instant, the pose of the next one: a step later.
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(drone["pose"][c].get<double>(), truth.X_WB.p[c], 0.05);
  }
  EXPECT_GT(drone["pose"][2].get<double>(), before["vehicles"][0]["pose"][2].get<double>() + 0.5);
  EXPECT_EQ(drone["links"].size(), simulation.vehicles()[0]->vehicle().links().size());
  EXPECT_EQ(after["ground"]["rows"].size(), 4u);
}

TEST_F(LivePage, IsTheSameForTheSameRun) {
  const Simulation a(scenario_, registry_), b(scenario_, registry_);
  const auto files_a = files_of(a), files_b = files_of(b);
  for (const auto& [path, file] : files_a) EXPECT_EQ(file.bytes, files_b.at(path).bytes) << path;
}

}  // namespace
}  // namespace vinerow::tools::live_page_test
