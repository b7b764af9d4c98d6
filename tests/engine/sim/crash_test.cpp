/// A wrecked vehicle ends or fails the run; the output states the vehicle, the reason and the time.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/record/log_reader.h"
#include "engine/run/run.h"
#include "tests/engine/sim/small_run.h"

namespace vinerow::crash_test {
namespace {

const char* const kScenario = R"(
vinerow: 1
name: two
duration_s: 0.5
world: {type: plain}
vehicles:
  drone:
    type: statue
    spawn: {x_m: 0, y_m: 0}
    controller: {type: teller, rate_Hz: 20}
  rover:
    type: statue
    spawn: {x_m: 3, y_m: 0}
    controller: {type: teller, rate_Hz: 20, finish_s: 0.3}
metrics: {travel: {type: travel}}
)";

class CrashRun : public test::RunFixture {
 protected:
  CrashRun() : RunFixture(kScenario) {}
  /// Lines of the event file whose text begins so.
  std::vector<nlohmann::json> events(const std::string& beginning) const {
    std::ifstream lines(folder_ / "events.jsonl");
    std::vector<nlohmann::json> found;
    for (std::string line; std::getline(lines, line);) {
      const auto event = nlohmann::json::parse(line);
      if (event["text"].get<std::string>().starts_with(beginning)) found.push_back(event);
    }
    return found;
  }
};

TEST_F(CrashRun, EndsAtTheCrashUnlessTheScenarioSaysOtherwise) {
  const run::RunResult result = run({"drone.crash_s=0.2"});
  EXPECT_EQ(result.status, run::RunStatus::kCriterionFailed);
  EXPECT_EQ(static_cast<int>(result.status), 1);
  EXPECT_DOUBLE_EQ(result.simulated_s, 0.2);
  EXPECT_FALSE(result.finished);
  EXPECT_EQ(result.error, "drone crashed at 0.200 s: hit the ground at 2.3 m/s");

  const nlohmann::json written = summary();
  EXPECT_EQ(written["exit_status"], 1);
  EXPECT_EQ(written["status"], "a vehicle crashed");
  EXPECT_EQ(written["error"], result.error);
  EXPECT_EQ(written["crashes"],
            nlohmann::json::parse(R"([{"vehicle": "drone", "time_s": 0.2, "kind": "crashed",
                                       "text": "hit the ground at 2.3 m/s"}])"));
  const auto crashed = events("crashed: hit the ground at 2.3 m/s");
  ASSERT_EQ(crashed.size(), 1u);
  EXPECT_DOUBLE_EQ(crashed[0]["t_s"], 0.2);
  EXPECT_EQ(crashed[0]["level"], "error");
  EXPECT_EQ(crashed[0]["source"], "drone");
  EXPECT_EQ(events("ended after a crash").size(), 1u);

  // The instant of the crash is in the log.
  Time last;
  const record::LogReader log(folder_ / "log.mcap");
  log.read<Odometry>("/drone/truth", [&](Time t, const Odometry&) { last = t; });
  EXPECT_EQ(last.ns, 200'000'000);
}

TEST_F(CrashRun, GoesOnForTheOthersWhereItIsToFailOnly) {
  const run::RunResult result = run({"drone.crash_s=0.1", "drone.on_crash=fail"});
  EXPECT_EQ(result.status, run::RunStatus::kCriterionFailed);
  // The rover finishes at 0.3 s; nobody waits for the wreck.
  EXPECT_DOUBLE_EQ(result.simulated_s, 0.3);
  EXPECT_FALSE(result.finished);
  ASSERT_EQ(result.crashes.size(), 1u);
  EXPECT_EQ(result.crashes[0].time.ns, 100'000'000);
  EXPECT_EQ(events("crashed: ").size(), 1u) << "told once, not at every step";
  EXPECT_EQ(result.metrics.at("rover").at("finished"), 1.0);
}

TEST_F(CrashRun, AllCrashesAreToldAndNobodyLeftIsTheEnd) {
  const run::RunResult result = run(
      {"drone.crash_s=0.1", "drone.on_crash=fail", "rover.crash_s=0.25", "rover.on_crash=fail"});
  EXPECT_DOUBLE_EQ(result.simulated_s, 0.25);
  EXPECT_EQ(result.error,
            "drone crashed at 0.100 s: hit the ground at 2.3 m/s; rover crashed at 0.250 s: hit "
            "the ground at 2.3 m/s");
  EXPECT_EQ(summary()["crashes"].size(), 2u);
}

TEST_F(CrashRun, RunsOnToTheEndWhereNobodyWaitsForControllers) {
  const run::RunResult result =
      run({"drone.crash_s=0.1", "drone.on_crash=fail", "stop_when_finished=false"});
  EXPECT_DOUBLE_EQ(result.simulated_s, 0.5);
  EXPECT_EQ(result.status, run::RunStatus::kCriterionFailed);
}

TEST_F(CrashRun, AVehicleThatFinishedAndThenCrashedHasNotFinished) {
  const run::RunResult result = run({"rover.crash_s=0.4"});
  EXPECT_DOUBLE_EQ(result.simulated_s, 0.4);
  EXPECT_EQ(result.metrics.at("rover").at("finished"), 0.0);
}

TEST_F(CrashRun, WithoutACrashThereIsNoWordOfIt) {
  const run::RunResult result = run({"drone.controller.finish_s=0.2"});
  EXPECT_EQ(result.status, run::RunStatus::kAllMet);
  EXPECT_TRUE(result.finished);
  EXPECT_TRUE(result.error.empty());
  EXPECT_FALSE(summary().contains("crashes"));
  EXPECT_EQ(summary()["status"], "all criteria met");
}

TEST_F(CrashRun, RefusesAnotherWordForWhatACrashDoes) {
  try {
    run({"drone.on_crash=explode"});
    FAIL() << "'explode' was taken";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "--set drone.on_crash=explode: vehicles.drone.on_crash = 'explode', must be one "
                 "of: end, fail");
  }
}

}  // namespace
}  // namespace vinerow::crash_test
