/// Paper A whole on four rows: flight, cloud, map, then two vehicles in the rows; and what becomes
/// of the mission when one of its phases is broken.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "engine/run/run.h"
#include "tests/scenarios/command.h"
#include "tests/support/folder_test.h"
#include "tools/parts/register_all.h"

namespace vinerow::cooperative_test {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

class CooperativeMission : public test::FolderTest {
 protected:
  CooperativeMission() : FolderTest("cooperative") { register_all(registry_); }

  run::RunResult run(std::vector<std::string> sets = {}) {
    scenario::Overrides overrides;
    overrides.sets = std::move(sets);
    run::RunOptions options;
    options.out = folder_;
    options.pictures = false;
    const run::RunResult result = run::run_scenario(
        scenario::load_scenario(test::scenario_file("cooperative_small"), registry_, overrides),
        registry_, options);
    for (const PhaseReport& phase : result.phases) {
      std::printf("%-12s %-11s %s\n", phase.name.c_str(), to_string(phase.state),
                  phase.reason.c_str());
    }
    return result;
  }
  static const PhaseReport& phase(const run::RunResult& result, const std::string& name) {
    for (const PhaseReport& report : result.phases) {
      if (report.name == name) return report;
    }
    throw std::logic_error(name);
  }

  Registry registry_;
};

TEST_F(CooperativeMission, FromFlightToRowsEveryPhaseSucceedsAndTwiceTheSameBits) {
  run::RunResult result = run();
  EXPECT_EQ(result.status, run::RunStatus::kAllMet);
  for (const PhaseReport& report : result.phases) {
    EXPECT_EQ(report.state, PhaseState::kSucceeded) << report.name << ": " << report.reason;
  }
  for (const CriterionResult& criterion : result.criteria) {
    EXPECT_TRUE(criterion.met) << criterion.name << ": " << criterion.value;
  }
  EXPECT_EQ(phase(result, "build_map").numbers.at("rows_found"), 4.0);
  // The rover follows where the quadrotor has been: it waits for the first alley.
  EXPECT_GT(result.metrics.at("rover").at("min_vehicle_distance_m"), 0.55);  // 0.60 m is reached
  result.lock.reset();  // the folder is free for the next run
  const run::RunResult again = run();
  EXPECT_EQ(again.digest, result.digest);
}

TEST_F(CooperativeMission, TooMuchWindKeepsTheSurveyFromBeginning) {
  const run::RunResult result = run({"world.wind.mean_speed_mps=9"});
  EXPECT_EQ(result.status, run::RunStatus::kCriterionFailed);
  EXPECT_EQ(phase(result, "survey").state, PhaseState::kFailed);
  EXPECT_THAT(phase(result, "survey").reason, StartsWith("no window of weak wind occurred"));
  EXPECT_EQ(phase(result, "spray").state, PhaseState::kBlocked);
}

TEST_F(CooperativeMission, AMapWithARowMissingIsNotWorkedOn) {
  const run::RunResult result = run({"phases.build_cloud.job.missing_rows=[2]"});
  EXPECT_EQ(result.status, run::RunStatus::kCriterionFailed);
  EXPECT_EQ(phase(result, "build_map").state, PhaseState::kFailed);
  EXPECT_THAT(phase(result, "build_map").reason, StartsWith("missed rows = "));
  EXPECT_THAT(phase(result, "build_map").reason, HasSubstr("(at least 4)"));
  EXPECT_EQ(phase(result, "build_map").numbers.at("rows_true"), 4.0);
  EXPECT_LE(phase(result, "build_map").numbers.at("rows_found"), 3.0);
  EXPECT_EQ(phase(result, "scout").state, PhaseState::kBlocked);
  EXPECT_EQ(phase(result, "spray").state, PhaseState::kBlocked);
}

TEST_F(CooperativeMission, ABlockedRoverStopsAndFailsAlone) {
  const run::RunResult result = run(
      {"world.obstacles=[{name: pallet, alley: 1, distance_m: 20, lateral_m: 0, size_m: [1.2, 0.8, "
       "0.6]}]"});
  EXPECT_EQ(result.status, run::RunStatus::kCriterionFailed);
  EXPECT_EQ(phase(result, "spray").state, PhaseState::kFailed);
  EXPECT_THAT(phase(result, "spray").reason,
              StartsWith("rover had not finished within its timeout of 400 s"));
  EXPECT_EQ(result.metrics.at("rover").at("contact_count"), 0.0)
      << "its rangers see what the map does not have";
  EXPECT_EQ(result.metrics.at("rover").at("alleys_driven"), 1.0);
  EXPECT_EQ(phase(result, "scout").state, PhaseState::kSucceeded)
      << "the quadrotor flies over it and home";
}

TEST_F(CooperativeMission, ACrashLeavesTheOtherAtWork) {
  // A rotor stops between the rows.
  const run::RunResult result =
      run({"drone.faults=[{kind: rotor_failure, rotor: 1, at_s: 330, remaining: 0}]"});
  EXPECT_EQ(phase(result, "scout").state, PhaseState::kFailed);
  EXPECT_THAT(phase(result, "scout").reason, HasSubstr("drone crashed"));
  // The rover goes on until it comes to the alley with the wreck; its phase fails for that reason.
  EXPECT_EQ(phase(result, "spray").state, PhaseState::kFailed);
  EXPECT_THAT(phase(result, "spray").reason,
              MatchesRegex("rover waits for alley [0-9]+, in which drone has stopped"));
  EXPECT_GT(phase(result, "spray").end->s(), phase(result, "scout").end->s() + 10.0);
}

}  // namespace
}  // namespace vinerow::cooperative_test
