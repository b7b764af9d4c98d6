/// Missions as graphs of phases: order, products, failures, verdicts and their files.

#include "engine/sim/mission.h"
#include "engine/core/error.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "engine/record/log_reader.h"
#include "engine/sensors/register_sensors.h"
#include "tests/engine/sim/mission_parts.h"
#include "tests/engine/sim/small_run.h"

namespace vinerow::mission_test {
namespace {

using ::testing::HasSubstr;

/// Survey for 2 s, a job of 3 s, then two vehicles side by side for 1 s and 4 s.
const char* const kScenario = R"(
vinerow: 1
name: graph
duration_s: 60
world: {type: plain}
vehicles:
  plane:
    type: statue
    spawn: {x_m: 0, y_m: 0}
    sensors: {camera: {type: clicker}}
    controller: {type: worker, work_s: 2}
  rover:
    type: statue
    spawn: {x_m: 1, y_m: 0}
    controller: {type: worker, work_s: 4}
  drone:
    type: statue
    spawn: {x_m: 2, y_m: 0}
    controller: {type: worker, work_s: 1}
metrics: {travel: {type: travel}}
phases:
  survey: {vehicles: [plane]}
  build_map: {job: {type: count_rows}, pictures: from survey, duration_s: 3}
  spray: {vehicles: [rover], map: from build_map, on_failure: continue}
  scout: {vehicles: [drone], map: from build_map, on_failure: continue}
criteria:
  - {metric: build_map.rows, min: 2}
)";

class MissionRun : public test::RunFixture {
 protected:
  MissionRun() : RunFixture(kScenario, test::mission_registry()) {
    PartSpec flyer;
    flyer.name = "flyer";
    flyer.description = "for tests";
    registry_.add_vehicle(flyer, [](const ParameterSet&, const VehicleContext&) {
      return std::make_unique<test::Statue>(0.0, true);
    });
  }
  /// When a vehicle's controller last wrote.
  Time last_work(const std::string& vehicle) const {
    Time last{-1};
    record::LogReader(folder_ / "log.mcap")
        .read<NamedValues>("/" + vehicle + "/map_rows",
                           [&](Time t, const NamedValues&) { last = t; });
    return last;
  }
  /// State, begin and end of every phase: "survey succeeded 0.0-2.0".
  static std::vector<std::string> phase_lines(const run::RunResult& result) {
    std::vector<std::string> lines;
    for (const PhaseReport& phase : result.phases) {
      std::ostringstream line;
      line.precision(2);
      line << phase.name << " " << to_string(phase.state) << std::fixed;
      if (phase.begin) line << " " << phase.begin->s();
      if (phase.end) line << "-" << phase.end->s();
      lines.push_back(line.str());
    }
    return lines;
  }
  static const PhaseReport& phase(const run::RunResult& result, const std::string& name) {
    for (const PhaseReport& report : result.phases) {
      if (report.name == name) return report;
    }
    throw std::logic_error(name);
  }
  std::string text_of(const char* file) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / file).rdbuf();
    return text.str();
  }
};

TEST_F(MissionRun, PhasesBeginWhenWhatTheyWaitForIsDone) {
  const run::RunResult result = run();
  EXPECT_EQ(result.status, run::RunStatus::kAllMet);
  EXPECT_TRUE(result.finished);
  // A controller says at its tick that it has finished; the next instant, 1 ms later, acts on it.
  EXPECT_EQ(phase_lines(result),
            (std::vector<std::string>{"survey succeeded 0.00-2.00", "build_map succeeded 2.00-5.00",
                                      "spray succeeded 5.00-9.00", "scout succeeded 5.00-6.00"}));
  EXPECT_NEAR(result.simulated_s, 9.0, 0.01);
}

TEST_F(MissionRun, ProductsReachThoseWhoNameThem) {
  const run::RunResult result = run();
  // Pictures at 0, 1 and 2 s, each published twice: the one at 2.0 is in the survey's last tick.
  EXPECT_EQ(phase(result, "build_map").numbers.at("rows"), 3.0);
  const record::LogReader log(folder_ / "log.mcap");
  std::vector<double> rows;
  Time first{-1};
  log.read<NamedValues>("/rover/map_rows", [&](Time t, const NamedValues& value) {
    if (rows.empty()) first = t;
    rows.push_back(value.values[0]);
  });
  ASSERT_FALSE(rows.empty());
  EXPECT_EQ(rows.front(), 3.0) << "the rover's controller was built on the made map";
  EXPECT_NEAR(first.s(), 5.0, 0.01) << "and ran from its phase's begin";
}

TEST_F(MissionRun, SameMissionSameDigestAndFiles) {
  const std::string digest = run().digest;
  const std::string junit = text_of("junit.xml");
  EXPECT_EQ(run().digest, digest);
  EXPECT_EQ(text_of("junit.xml"), junit);
  EXPECT_NE(run({"rover.controller.work_s=3"}).digest, digest);
}

TEST_F(MissionRun, AFailedJobBlocksWhatWaitsForItAndEndsTheMission) {
  const run::RunResult result = run({"phases.build_map.job.fails=true"});
  EXPECT_EQ(result.status, run::RunStatus::kCriterionFailed);
  EXPECT_EQ(phase(result, "build_map").state, PhaseState::kFailed);
  EXPECT_EQ(phase(result, "build_map").reason, "the pictures are too dark");
  EXPECT_EQ(phase(result, "spray").state, PhaseState::kBlocked);
  EXPECT_EQ(phase(result, "spray").reason, "waits for 'build_map', which failed");
  EXPECT_NEAR(result.simulated_s, 5.0, 0.01);
  ASSERT_EQ(result.criteria.size(), 1u);
  EXPECT_FALSE(result.criteria[0].met) << "a number that was not measured meets nothing";
}

TEST_F(MissionRun, ATimeoutFailsItsPhaseAloneWhereOthersMayContinue) {
  const run::RunResult result = run(
      {"rover.controller.work_s=1000", "phases.spray.timeout_s=2", "drone.controller.work_s=6"});
  EXPECT_EQ(phase_lines(result)[2], "spray failed 5.00-7.00");
  EXPECT_EQ(phase(result, "spray").reason, "rover had not finished within its timeout of 2 s");
  EXPECT_EQ(phase_lines(result)[3], "scout succeeded 5.00-11.00");
  EXPECT_EQ(result.status, run::RunStatus::kCriterionFailed);
}

TEST_F(MissionRun, AnAbortStopsWhatRuns) {
  const run::RunResult result = run({"rover.controller.work_s=1000", "phases.spray.timeout_s=2",
                                     "phases.spray.on_failure=abort", "drone.controller.work_s=6"});
  EXPECT_EQ(phase_lines(result)[3], "scout stopped 5.00-7.00");
  EXPECT_EQ(phase(result, "scout").reason, "'spray' failed, which ends the mission");
}

TEST_F(MissionRun, WhatFailsInTheAirIsLeftToItsController) {
  // The scout's timeout is at 6 s, the rover works until 9 s.
  const std::vector<std::string> late = {"drone.controller.work_s=1000",
                                         "phases.scout.timeout_s=1"};
  std::vector<std::string> flies = late;
  flies.push_back("drone.type=flyer");
  EXPECT_EQ(phase_lines(run(flies))[3], "scout failed 5.00-6.00");
  EXPECT_GT(last_work("drone").s(), 8.9) << "it is not parked in mid-air";
  EXPECT_EQ(phase_lines(run(late))[3], "scout failed 5.00-6.00");
  EXPECT_LT(last_work("drone").s(), 6.01) << "what stands on the ground is";
  // What has finished, or lies on the ground, is parked, whether it flies or not.
  EXPECT_EQ(phase_lines(run({"drone.type=flyer"}))[3], "scout succeeded 5.00-6.00");
  EXPECT_LT(last_work("drone").s(), 6.01);
}

TEST_F(MissionRun, ACrashLeavesTheOthersAtWork) {
  const run::RunResult result = run({"drone.crash_s=5.5", "phases.scout.on_failure=continue"});
  EXPECT_EQ(phase(result, "scout").state, PhaseState::kFailed);
  EXPECT_THAT(phase(result, "scout").reason, HasSubstr("drone crashed at 5.500 s"));
  EXPECT_EQ(phase_lines(result)[2], "spray succeeded 5.00-9.00");
  EXPECT_EQ(result.status, run::RunStatus::kCriterionFailed);
}

TEST_F(MissionRun, AMissedCriterionFailsItsPhase) {
  const run::RunResult result = run({"phases.build_map.criteria=[{metric: rows, min: 16}]"});
  EXPECT_EQ(phase(result, "build_map").state, PhaseState::kFailed);
  EXPECT_EQ(phase(result, "build_map").reason, "missed rows = 3 (at least 16)");
  ASSERT_EQ(phase(result, "build_map").criteria.size(), 1u);
}

TEST_F(MissionRun, TheEndOfTheRunFailsWhatRunsAndNamesWhatWasNotReached) {
  const run::RunResult result = run({"duration_s=3"});
  EXPECT_EQ(phase(result, "build_map").reason, "the run ended after its duration of 3 s");
  EXPECT_EQ(phase(result, "spray").state, PhaseState::kNotStarted);
  EXPECT_EQ(result.status, run::RunStatus::kCriterionFailed);
}

TEST_F(MissionRun, WeatherIsWaitedFor) {
  const run::RunResult calm =
      run({"phases.survey.weather={max_wind_mps: 1, over_s: 5, wait_s: 0}"});
  EXPECT_NEAR(phase(calm, "survey").begin->s(), 4.0, 0.01) << "the first five readings";
  EXPECT_EQ(calm.status, run::RunStatus::kAllMet);
}

TEST_F(MissionRun, VerdictsAreTestCases) {
  run({"phases.build_map.job.fails=true"});
  const std::string xml = text_of("junit.xml");
  EXPECT_THAT(xml, HasSubstr("<testsuite name=\"graph\" tests=\"6\" failures=\"2\" errors=\"0\" "
                             "skipped=\"2\""));
  EXPECT_THAT(xml, HasSubstr("<testcase classname=\"graph.phases\" name=\"build_map\" "
                             "time=\"3.000\"><failure message=\"the pictures are too dark\"/>"));
  EXPECT_THAT(xml, HasSubstr("name=\"spray\" time=\"0.000\"><skipped message=\"blocked: waits for "
                             "'build_map', which failed\"/>"));
}

TEST_F(MissionRun, TheSummaryTellsThePhases) {
  run();
  const nlohmann::json phases = summary()["phases"];
  ASSERT_EQ(phases.size(), 4u);
  EXPECT_EQ(phases[1]["name"], "build_map");
  EXPECT_EQ(phases[1]["kind"], "job");
  EXPECT_EQ(phases[1]["job"], "count_rows");
  EXPECT_EQ(phases[1]["state"], "succeeded");
  EXPECT_EQ(phases[1]["after"], (nlohmann::json{"survey"}));
  EXPECT_EQ(phases[1]["product"]["kind"], "map");
  EXPECT_EQ(phases[2]["vehicles"], (nlohmann::json{"rover"}));
  EXPECT_TRUE(phases[2]["metrics"]["rover"].contains("time_s"));
}

TEST_F(MissionRun, TimesOfAPhaseCountFromItsBegin) {
  const run::RunResult result = run();
  // 4 s of work; without that it would be 9 s of the run.
  EXPECT_NEAR(result.metrics.at("rover").at("time_s"), 4.0, 0.1);
}

TEST_F(MissionRun, AVehicleMayWorkInSeveralPhasesOneAfterTheOther) {
  const run::RunResult result =
      run({"phases.again={vehicles: [plane], after: [scout]}", "drone.controller.work_s=1"});
  EXPECT_EQ(phase_lines(result).back(), "again succeeded 6.00-8.00");
  EXPECT_EQ(result.status, run::RunStatus::kAllMet);
}

TEST_F(MissionRun, FaultsOfPartsAreFoundBeforeAnythingRuns) {
  const auto fault_of = [this](const char* set) -> std::string {
    try {
      run({set});
    } catch (const ConfigError& fault) {
      return fault.what();
    }
    return "";
  };
  EXPECT_THAT(fault_of("criteria=[{metric: rover.tme_s, max: 1}]"),
              HasSubstr("did you mean 'rover.time_s'?"));
  EXPECT_THAT(fault_of("phases.spray.criteria=[{metric: rover.tme_s, max: 1}]"),
              HasSubstr("did you mean 'rover.time_s'?"));
  EXPECT_THAT(fault_of("criteria=[{metric: rover.finished, min: 1e9}]"),
              HasSubstr("no value of rover.finished meets min = 1e+09 (possible: 0 or 1)"));
  EXPECT_THAT(fault_of("phases.spray.criteria=[{metric: rover.distance_m, max: -1}]"),
              HasSubstr("no value of rover.distance_m meets max = -1 (possible: from 0)"));
  EXPECT_THAT(fault_of("traffic={reserve_alleys: [rover, drone]}"),
              HasSubstr("neither guidance nor controller of 'rover' reads the signal 'authority', "
                        "so it cannot wait for an alley"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "events.jsonl"));
}

TEST_F(MissionRun, HowNearOthersCameIsMeasured) {
  // Boxes of 1 m on a line, 1 m apart.
  EXPECT_EQ(run().metrics.at("rover").at("min_vehicle_distance_m"), 0.0);
  EXPECT_EQ(run({"drone.spawn.x_m=4"}).metrics.at("drone").at("min_vehicle_distance_m"), 2.0);
}

/// Refuses its first step, as a camera that sees nothing.
class Picky final : public Controller {
 public:
  void connect(Ports& ports) override { actuators_ = ports.write<NamedValues>("actuators"); }
  bool finished() const override { return false; }
  void step(Time) override { throw ConfigError("no start like this"); }

 private:
  SignalWriter<NamedValues> actuators_;
};

class NoJob final : public Job {
 public:
  Result<JobOutcome> run(const std::map<std::string, Product>&) override {
    ADD_FAILURE() << "a rehearsal ran a job";
    return Failure{"not to be run"};
  }
};

TEST_F(MissionRun, ACameraOfALaterPhaseThatSeesNothingIsRefusedBeforeTheRun) {
  sensors::register_sensors(registry_);
  for (const char* const type : {"camera", "lidar_3d"}) {
    const std::string sets =
        fmt::format("rover.sensors={{front: {{type: {}, position_m: [0, 0, -1]}}}}", type);
    try {
      run({sets});
      ADD_FAILURE() << type << " was accepted";
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr("rover.sensors.front: the"));
      EXPECT_THAT(error.what(), HasSubstr("is below the ground: change its position_m"));
    }
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(MissionRun, ARehearsalRunsNoJobAndTakesTheFirstStepOfVehiclesBesideIt) {
  PartSpec spec;
  spec.name = "no_job";
  spec.description = "for tests";
  spec.gives = ProductKind::kMap;
  registry_.add_job(
      spec, [](const ParameterSet&, const JobContext&) { return std::make_unique<NoJob>(); });
  spec.name = "picky";
  spec.gives.reset();
  spec.default_rate_Hz = 20.0;
  registry_.add_controller(spec, [](const ParameterSet&, const ControllerContext&) {
    return std::make_unique<Picky>();
  });
  scenario::Overrides overrides;
  overrides.sets = {"criteria=[]",
                    "phases={prepare: {job: {type: no_job}}, drive: {vehicles: [plane, rover, "
                    "drone], after: []}}"};
  const auto rehearse = [&] {
    return run::rehearse_run(scenario::parse_scenario(kScenario, ".", registry_, overrides),
                             registry_);
  };
  EXPECT_TRUE(rehearse().empty());
  overrides.sets.push_back("rover.controller={type: picky}");
  try {
    rehearse();
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("rover.controller: no start like this"));
  }
}

}  // namespace
}  // namespace vinerow::mission_test
