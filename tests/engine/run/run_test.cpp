/// Additional output of parts reaches the files of a run: events, planners' numbers, trees and
/// maps.

#include "engine/run/run.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/playback/log_trace.h"
#include "engine/record/log_reader.h"
#include "tests/engine/sim/small_run.h"

namespace vinerow::run::run_test {
namespace {

const char* const kScenario = R"(
vinerow: 1
name: small
duration_s: 0.5
world: {type: plain, has_map: true}
vehicles:
  rover:
    type: statue
    spawn: {x_m: 0, y_m: 0}
    planner: {type: straight_ahead}
    controller: {type: teller, rate_Hz: 20}
metrics: {travel: {type: travel}}
)";

class SmallRun : public test::RunFixture {
 protected:
  SmallRun() : RunFixture(kScenario) {}
  record::LogReader log() const { return record::LogReader(folder_ / "log.mcap"); }
};

TEST_F(SmallRun, APartsEventReachesTheRunsEventsOnce) {
  run();
  // The file: one line each, at its time, with the part as source where it names none.
  std::ifstream lines(folder_ / "events.jsonl");
  std::vector<nlohmann::json> reported;
  for (std::string line; std::getline(lines, line);) {
    const auto event = nlohmann::json::parse(line);
    if (event["text"] == "blocked" || event["text"] == "goes on") reported.push_back(event);
  }
  ASSERT_EQ(reported.size(), 2u);
  EXPECT_DOUBLE_EQ(reported[0]["t_s"], 0.1);
  EXPECT_EQ(reported[0]["level"], "warning");
  EXPECT_EQ(reported[0]["source"], "rover.controller");
  EXPECT_DOUBLE_EQ(reported[1]["t_s"], 0.3);
  EXPECT_EQ(reported[1]["source"], "rover.dwa");
  // The log: on "run/events" and, as it was written, on the part's own channel.
  int in_run = 0, own = 0;
  const auto is_reported = [](const Event& e) {
    return e.text == "blocked" || e.text == "goes on";
  };
  log().read<Event>("/run/events", [&](Time, const Event& e) { in_run += is_reported(e); });
  log().read<Event>("/rover/controller_event",
                    [&](Time, const Event& e) { own += is_reported(e); });
  EXPECT_EQ(in_run, 2);
  EXPECT_EQ(own, 2);
}

TEST_F(SmallRun, TimesOfTheSummaryAreTheNearestDoubles) {
  // 300,000,000 ns * 1e-9 is 0.30000000000000004.
  run({"duration_s=0.3", "rover.crash_s=0.3"});
  EXPECT_EQ(summary()["simulated_s"], 0.3);
  EXPECT_EQ(summary()["metrics"]["rover"]["time_s"], 0.3);
  EXPECT_EQ(summary()["crashes"][0]["time_s"], 0.3);
}

TEST_F(SmallRun, EventsAndTreesAreNotInTheDigest) {
  const std::string digest = run().digest;
  EXPECT_EQ(run({"rover.controller.tells=false"}).digest, digest);
  EXPECT_EQ(run({"rover.planner.reports=false"}).digest, digest);
  // The check can fail: the map is a signal like others.
  EXPECT_NE(run({"world.has_map=false"}).digest, digest);
}

TEST_F(SmallRun, APlannersNumbersReachTheSummaryAndItsTreeTheLog) {
  run();
  EXPECT_EQ(summary()["planning"]["rover"],
            (nlohmann::json{{"clearance_m", 0.25}, {"nodes", 42.0}}));
  std::vector<LineList> trees;
  log().read<LineList>("/rover/plan_tree",
                       [&](Time, const LineList& tree) { trees.push_back(tree); });
  ASSERT_EQ(trees.size(), 1u);
  EXPECT_EQ(trees[0].points_W, (std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}}));
}

TEST_F(SmallRun, WithoutAReportThereIsNothingToTell) {
  run({"rover.planner.reports=false"});
  EXPECT_FALSE(summary().contains("planning"));
  int trees = 0;
  log().read<LineList>("/rover/plan_tree", [&](Time, const LineList&) { ++trees; });
  EXPECT_EQ(trees, 0);
}

TEST_F(SmallRun, AVehiclesOwnMapIsInTheLogOnceAsEdges) {
  const std::string digest = run().digest;
  EXPECT_EQ(run({"rover.map={type: one_sheet}"}).digest, digest) << "it follows from the world";
  std::vector<LineList> maps;
  log().read<LineList>("/rover/map_edges", [&](Time t, const LineList& map) {
    EXPECT_EQ(t.ns, 0);
    maps.push_back(map);
  });
  ASSERT_EQ(maps.size(), 1u);
  EXPECT_EQ(maps[0].points_W,
            (std::vector<Eigen::Vector3d>{
                {0, 0, 0}, {3, 0, 0}, {3, 0, 0}, {3, 4, 0}, {0, 0, 0}, {3, 4, 0}}));
  run({"rover.map={type: one_sheet, has_meshes: false}"});
  const auto without_meshes = log();
  for (const record::ChannelInfo& channel : without_meshes.info().channels) {
    EXPECT_NE(channel.topic, "/rover/map_edges");
  }
}

TEST_F(SmallRun, EstimatesAndMapsAreReadFromTheLogWhereTheyAreAskedFor) {
  run({"rover.map={type: one_sheet}"});
  const playback::VehicleTrace plain = playback::read_trace(log(), {"rover"}).vehicles.at("rover");
  EXPECT_FALSE(plain.truth.empty());
  EXPECT_TRUE(plain.estimates.empty());
  EXPECT_TRUE(plain.map_edges.points_W.empty());
  playback::TraceWishes wishes;
  wishes.estimates = wishes.map_edges = true;
  const playback::VehicleTrace all =
      playback::read_trace(log(), {"rover"}, wishes).vehicles.at("rover");
  ASSERT_EQ(all.estimates.size(), 1u) << "the truth is none";
  EXPECT_EQ(all.estimates.at("estimate").times, all.truth.times);
  EXPECT_EQ(all.map_edges.points_W.size(), 6u);
}

TEST(OdometryAt, CovarianceGoesStraightFromSampleToSample) {
  playback::Trace<Odometry> trace;
  trace.times = {Time{0}, Time{1'000'000'000}};
  trace.values.resize(2);
  trace.values[1].X_WB.p = {4, 0, 0};
  trace.values[0].position_variance_m2 = {1, 2, 3};
  trace.values[1].position_variance_m2 = {5, 2, 7};
  trace.values[1].position_covariance_m2 = {0.4, 0, 0};
  const Odometry at = playback::odometry_at(trace, Time{250'000'000});
  EXPECT_LT((at.X_WB.p - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((at.position_variance_m2 - Eigen::Vector3d(2, 2, 4)).norm(), 1e-12);
  EXPECT_LT((at.position_covariance_m2 - Eigen::Vector3d(0.1, 0, 0)).norm(), 1e-12);
}

TEST_F(SmallRun, TheMapIsInTheLogOnceWhereTheWorldHasOne) {
  run();
  std::vector<OccupancyGrid> maps;
  log().read<OccupancyGrid>("/run/map", [&](Time t, const OccupancyGrid& map) {
    EXPECT_EQ(t.ns, 0);
    maps.push_back(map);
  });
  ASSERT_EQ(maps.size(), 1u);
  EXPECT_EQ(maps[0].columns, 3);
  EXPECT_EQ(maps[0].corner_W, Eigen::Vector2d(1, 2));
  EXPECT_EQ(maps[0].cells, (std::vector<std::uint8_t>{0, 1, 0, 1, 1, 0}));
  run({"world.has_map=false"});
  const auto without_map = log();
  for (const record::ChannelInfo& channel : without_map.info().channels) {
    EXPECT_NE(channel.topic, "/run/map");
  }
}

}  // namespace
}  // namespace vinerow::run::run_test
