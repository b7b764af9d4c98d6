/// The files of a run: when they are written, who may write them, and what a log adds to signals.

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "engine/core/error.h"
#include "engine/record/cdr.h"
#include "engine/record/log_reader.h"
#include "engine/run/earlier_run.h"
#include "engine/run/folder_lock.h"
#include "engine/sensors/register_sensors.h"
#include "tests/engine/record/raw_messages.h"
#include "tests/engine/sim/small_run.h"

namespace vinerow::run::run_files_test {
namespace {

const char* const kScenario = R"(
vinerow: 1
name: small
duration_s: 0.5
world: {type: plain}
vehicles:
  rover:
    type: statue
    spawn: {x_m: 1, y_m: 2, yaw_deg: 90}
    sensors:
      lidar: {type: lidar, rate_Hz: 10, position_m: [0.5, 0, 1], rotation_deg: [0, 0, 90]}
      gps: {type: gps, rate_Hz: 5, position_m: [0, 0, 2]}
    planner: {type: straight_ahead}
    controller: {type: teller, rate_Hz: 20}
metrics: {travel: {type: travel}}
)";

Registry registry_with_sensors() {
  Registry registry = test::small_registry();
  sensors::register_sensors(registry);
  return registry;
}

class RunFiles : public test::RunFixture {
 protected:
  RunFiles() : RunFixture(kScenario, registry_with_sensors()) {}
  record::LogReader log() const { return record::LogReader(folder_ / "log.mcap"); }
};

TEST_F(RunFiles, OneFolderBelongsToOneRun) {
  run();
  {
    const FolderLock other(folder_);
    try {
      run();
      FAIL();
    } catch (const ConfigError& error) {
      EXPECT_EQ(std::string(error.what()),
                "folder '" + folder_.string() +
                    "' is in use by another run: wait until it ends, or give this one a folder of "
                    "its own (--out)");
    }
    EXPECT_TRUE(log().info().complete) << "the first run's results are still there";
    EXPECT_EQ(summary()["scenario"], "small");
  }
  const RunResult held = run();
  EXPECT_THROW(run(), ConfigError) << "while its pictures may be drawn";
}

TEST_F(RunFiles, TheVerdictIsThereBeforeAPictureIsDrawn) {
  options_.pictures = true;
  int judged = 0, progress = 0;
  options_.judged = [&](const RunResult& result) {
    ++judged;
    EXPECT_EQ(progress, 0);
    EXPECT_EQ(summary()["digest"], result.digest);
    EXPECT_TRUE(summary()["pictures"].empty());
    EXPECT_TRUE(std::filesystem::exists(folder_ / "junit.xml"));
    EXPECT_TRUE(result.pictures.empty());
  };
  options_.picture_progress = [&](int, int total) {
    ++progress;
    EXPECT_EQ(judged, 1);
    EXPECT_EQ(total, 1);
  };
  const RunResult result = run();
  EXPECT_EQ(judged, 1);
  if (result.pictures.empty()) GTEST_SKIP() << result.picture_note;
  // Without `pictures:` a chase camera behind the first vehicle, at the end.
  EXPECT_EQ(result.pictures, (std::vector{folder_ / "frames" / "chase_000000500.png"}));
  EXPECT_EQ(summary()["pictures"].size(), 1u);
}

TEST_F(RunFiles, PicturesThatAreNeverDueAreReported) {
  options_.pictures = true;
  const RunResult result = run({"pictures={times_s: [9]}"});  // the run ends at 0.5 s
  if (result.picture_note.find("OSMesa") != std::string::npos) GTEST_SKIP() << result.picture_note;
  EXPECT_EQ(result.status, RunStatus::kAllMet);
  EXPECT_EQ(result.picture_note, "no frame is due within the run");
  EXPECT_EQ(summary()["picture_note"], "no frame is due within the run");
}

TEST_F(RunFiles, AnInterruptWhileDrawingKeepsTheVerdict) {
  options_.pictures = true;
  bool over = false;
  int queries = 0;
  options_.judged = [&](const RunResult&) { over = true; };
  options_.interrupted = [&] { return over && ++queries > 1; };  // when all is ready to draw
  const RunResult result = run();
  if (result.picture_note.find("OSMesa") != std::string::npos) GTEST_SKIP() << result.picture_note;
  EXPECT_EQ(result.status, RunStatus::kAllMet);
  EXPECT_EQ(result.picture_note, "interrupted after 0 of 1");
  EXPECT_EQ(summary()["picture_note"], "interrupted after 0 of 1");
  EXPECT_EQ(summary()["status"], "all criteria met");
}

TEST_F(RunFiles, WhatAnEarlierRunLeftIsNotTakenForThisOnes) {
  for (const char* sub : {"frames", "canopy", "robot_description/rover"}) {
    std::filesystem::create_directories(folder_ / sub);
  }
  const std::vector<std::string> of_run = {"scenario.resolved.yaml",
                                           "summary.json",
                                           "junit.xml",
                                           "report.html",
                                           "log.mcap.part",
                                           "frames/chase_000000500.png",
                                           "canopy/rover.json",
                                           "coverage_plane.png",
                                           "robot_description/rover.urdf",
                                           "robot_description/rover/body.dae"};
  const std::vector<std::string> of_others = {"frames/holiday.jpg", "canopy/field_notes.txt",
                                              "photo.png", "film.part"};
  for (const auto& names : {of_run, of_others}) {
    for (const std::string& name : names) std::ofstream(folder_ / name) << "earlier";
  }
  options_.judged = [&](const RunResult&) {
    for (const std::string& name : of_run) {
      const bool is_written_now =
          name == "scenario.resolved.yaml" || name == "summary.json" || name == "junit.xml";
      EXPECT_EQ(std::filesystem::exists(folder_ / name), is_written_now) << name;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "robot_description"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / ".earlier_run"));
  };
  run();
  EXPECT_EQ(summary()["scenario"], "small");
  for (const std::string& name : of_others) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  }
}

TEST_F(RunFiles, AFolderWithoutARunKeepsItsFiles) {
  const std::vector<std::string> names = {"frames/a.png", "canopy/a.json", "coverage_plan.png",
                                          "report.html", "profile.json"};
  for (const std::string& name : names) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << "mine";
  }
  run();
  for (const std::string& name : names) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  }
}

TEST_F(RunFiles, ARunThatIsRefusedOrStartsAgainRemovesItsOwnFilesAlone) {
  const auto write = [&](const std::vector<std::string>& names) {
    std::filesystem::create_directories(folder_ / "frames");
    for (const std::string& name : names) std::ofstream(folder_ / name) << name;
  };
  const auto files = [&] {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      if (entry.is_regular_file()) {
        found.insert(entry.path().lexically_relative(folder_).string());
      }
    }
    return found;
  };
  const std::set<std::string> mine = {"frames/a.png", "report.html"};
  write({"frames/a.png", "report.html"});
  EarlierRun none(folder_);
  for (const bool again : {true, false}) {
    write({"scenario.resolved.yaml", "log.mcap", "frames/b.png"});
    again ? none.remove_new() : none.put_back();
    EXPECT_EQ(files(), mine);
  }
}

TEST_F(RunFiles, SensorsStandInTheTreeOfFrames) {
  run();
  struct Found {
    std::string parent, child;
    Pose X_PC;
  };
  std::vector<Found> found;
  std::map<std::string, std::string> frames;  // of readings, by topic
  test::read_raw(folder_ / "log.mcap", [&](Time t, const record::ChannelInfo& channel,
                                           const std::vector<std::uint8_t>& bytes) {
    record::CdrReader in(bytes);
    const auto skip_time = [&] { in.read<std::int32_t>(), in.read<std::uint32_t>(); };
    if (channel.topic == "/tf_static") {
      EXPECT_EQ(t.ns, 0);
      EXPECT_EQ(channel.schema, "tf2_msgs/msg/TFMessage");
      EXPECT_NE(channel.metadata.at("offered_qos_profiles").find("durability: 1"),
                std::string::npos)
          << "transient local: who subscribes later still gets it";
      found.resize(in.read_count(1));
      for (Found& one : found) {
        skip_time();
        one.parent = in.read_text();
        one.child = in.read_text();
        in.read(one.X_PC.p);
        in.read_doubles(one.X_PC.q.coeffs().data(), 4);
      }
      EXPECT_TRUE(in.ok());
    } else if (channel.topic == "/rover/lidar" || channel.topic == "/rover/gps" ||
               channel.topic == "/rover/gps_truth") {
      skip_time();
      frames[channel.topic] = in.read_text();
    }
  });
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].parent, "rover/base_link");
  EXPECT_EQ(found[0].child, "rover/lidar");
  EXPECT_LT((found[0].X_PC.p - Eigen::Vector3d(0.5, 0, 1)).norm(), 1e-12);
  EXPECT_LT((found[0].X_PC.q * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_EQ(found[1].child, "rover/gps");
  EXPECT_EQ(frames, (std::map<std::string, std::string>{{"/rover/lidar", "rover/lidar"},
                                                        {"/rover/gps", "rover/gps"},
                                                        {"/rover/gps_truth", "rover/gps"}}));
}

TEST_F(RunFiles, WhatALogAddsIsNotInTheDigest) {
  const std::string digest = run().digest;
  options_.log = false;
  EXPECT_EQ(run().digest, digest);
}

TEST_F(RunFiles, TheTruthOfAScanIsStoredOnce) {
  run();
  const auto reader = log();
  std::map<std::string, std::uint64_t> counts;
  for (const record::ChannelInfo& channel : reader.info().channels) {
    if (channel.topic.find("lidar") != std::string::npos) counts[channel.topic] = channel.messages;
  }
  EXPECT_EQ(counts,
            (std::map<std::string, std::uint64_t>{
                {"/rover/lidar", 6}, {"/rover/lidar/exact", 6}, {"/rover/lidar_truth", 6}}));
  std::vector<LaserScan> truths;
  reader.read<LaserScan>("/rover/lidar_truth",
                         [&](Time, const LaserScan& scan) { truths.push_back(scan); });
  ASSERT_EQ(truths.size(), 6u);
  EXPECT_FALSE(truths[0].ranges_m.empty());
  EXPECT_LT((truths[0].X_WS.p - Eigen::Vector3d(1, 2.5, 1)).norm(), 1e-6);
}

TEST_F(RunFiles, RehearsingRefusesWhatARunRefusesAndWritesNothing) {
  const auto rehearse = [&](const std::vector<std::string>& sets) -> std::string {
    scenario::Overrides overrides;
    overrides.sets = sets;
    try {
      rehearse_run(scenario::parse_scenario(kScenario, ".", registry_, overrides), registry_);
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  };
  const auto refusal_of_run = [&](const std::vector<std::string>& sets) -> std::string {
    try {
      run(sets);
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(rehearse({}), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
  const std::string metric = "criteria=[{metric: rover.distanc_m, max: 1}]";
  EXPECT_NE(rehearse({metric}).find("did you mean 'rover.distance_m'?"), std::string::npos);
  EXPECT_EQ(rehearse({metric}), refusal_of_run({metric}));
  const std::string plan = "rover.planner.refuses=true";
  EXPECT_NE(rehearse({plan}).find("rover.planner (straight_ahead): there is no way"),
            std::string::npos);
  EXPECT_EQ(rehearse({plan}), refusal_of_run({plan}));
}

}  // namespace
}  // namespace vinerow::run::run_files_test
