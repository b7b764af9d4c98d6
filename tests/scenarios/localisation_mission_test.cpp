/// Paper C in whole runs: estimators as observers of a flight on the truth between the rows of a
/// sloped vineyard, and missions on the estimate alone. Under full physics, with echoes from the
/// true leaves.

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/scenarios/command.h"
#include "tests/scenarios/seeds.h"
#include "vinerow/testing.h"

namespace vinerow::localisation_mission_test {
namespace {

using test::scenario_file;
using testing::TestRun;

TestRun fly(const std::string& scenario, int seed = 1, std::vector<std::string> sets = {}) {
  sets.push_back("seed=" + std::to_string(seed));
  TestRun run = TestRun::from_file(scenario_file(scenario), sets);
  run.run_to_end();
  return run;
}

struct Errors {
  double lateral_m = 0.0, longitudinal_m = 0.0;
};
Errors errors_of(TestRun& run, const std::string& estimator) {
  return {run.metric("drone", estimator + "_lateral_rms_m"),
          run.metric("drone", estimator + "_longitudinal_rms_m")};
}

TEST(LocalisationMission, TheMapTakesMostOfTheErrorAway) {
  TestRun run = fly("localisation_m100");
  const Errors without = errors_of(run, "no_map");
  for (const char* name : {"map_localisation", "range_ekf", "paper_c", "no_map"}) {
    const Errors errors = errors_of(run, name);
    std::printf("%-17s %.4f / %.4f m, NEES %.2f\n", name, errors.lateral_m, errors.longitudinal_m,
                run.metric("drone", std::string(name) + "_nees_mean"));
  }
  // Paper C, table 3: 76 % laterally, 42 % along the row.
  for (const char* name : {"map_localisation", "range_ekf"}) {
    EXPECT_LT(errors_of(run, name).lateral_m, 0.24 * without.lateral_m) << name;
    EXPECT_LT(errors_of(run, name).longitudinal_m, 0.58 * without.longitudinal_m) << name;
    // What is stated is wider than the walls' error: too careful rather than too sure.
    EXPECT_LT(run.metric("drone", std::string(name) + "_nees_mean"), 2.4) << name;
  }
  EXPECT_EQ(run.metric("drone", "map_localisation_consistent"), 1.0);
}

TEST(LocalisationMission, EachSensorHelpsTheMoreTheFewerThereAre) {
  // The lateral error falls from none to one to two; beyond four little is gained.
  std::vector<double> lateral_m;
  for (const char* count : {"0", "1", "2", "4", "8"}) {
    const std::string name = *count == '0' ? "no_map" : "map_localisation";
    Errors mean;
    for (int seed = 1; seed <= 2; ++seed) {
      TestRun run = fly(std::string("localisation_sensors_") + count, seed);
      const Errors errors = errors_of(run, name);
      mean.lateral_m += 0.5 * errors.lateral_m;
      mean.longitudinal_m += 0.5 * errors.longitudinal_m;
    }
    std::printf("%s sensors: %.4f / %.4f m\n", count, mean.lateral_m, mean.longitudinal_m);
    lateral_m.push_back(mean.lateral_m);
  }
  EXPECT_LT(lateral_m[1], 0.53 * lateral_m[0]) << "paper C: 47 % less with one";
  EXPECT_LT(lateral_m[2], lateral_m[1]);
  EXPECT_LT(lateral_m[3], 0.28 * lateral_m[0]) << "paper C: 72 % less with four";
  EXPECT_LT(std::abs(lateral_m[4] - lateral_m[3]), 0.5 * (lateral_m[1] - lateral_m[3]));
}

TEST(LocalisationMission, TenSecondsWithoutFixesAreNotSeenLaterally) {
  TestRun run = fly("localisation_gps_outage");
  EXPECT_LT(run.metric("drone", "estimate_lateral_rms_m"), 0.03);
  EXPECT_GE(run.metric("drone", "min_clearance_m"), 0.3);
}

TEST(LocalisationMission, AnOldMapMisleadsItLittle) {
  TestRun run = fly("localisation_map_gap");
  EXPECT_LT(run.metric("drone", "estimate_lateral_rms_m"), 0.025);
  EXPECT_LT(run.metric("drone", "estimate_longitudinal_rms_m"), 0.15);
  EXPECT_GE(run.metric("drone", "min_clearance_m"), 0.3);
}

TEST(LocalisationMission, AMapBesideTheTruthIsToldOrSeen) {
  TestRun run = fly("localisation_map_bias");
  EXPECT_EQ(run.metric("drone", "estimate_consistent"), 1.0) << "with the map's shift as a state";
  EXPECT_EQ(run.metric("drone", "range_ekf_consistent"), 0.0) << "without";
  EXPECT_GE(run.metric("drone", "min_clearance_m"), 0.3);
}

/// Twenty seeds: other noise, other wind, another survey each time.
class ClosedLoopSeeds : public ::testing::TestWithParam<int> {};

TEST_P(ClosedLoopSeeds, QuadrotorAndRoverWorkOnTheirEstimates) {
  for (int seed = GetParam(); seed < GetParam() + test::seeds_of_group(5); ++seed) {
    SCOPED_TRACE(seed);
    TestRun run = fly("localisation_closed_loop", seed);
    std::printf(
        "seed %2d: drone %.3f / %.3f m, clearance %.3f m; rover %.3f / %.3f m, %.3f m\n", seed,
        run.metric("drone", "estimate_lateral_rms_m"),
        run.metric("drone", "estimate_longitudinal_rms_m"), run.metric("drone", "min_clearance_m"),
        run.metric("rover", "estimate_lateral_rms_m"),
        run.metric("rover", "estimate_longitudinal_rms_m"), run.metric("rover", "min_clearance_m"));
    for (const char* vehicle : {"drone", "rover"}) {
      EXPECT_EQ(run.metric(vehicle, "alleys_driven"), 2.0) << vehicle;
      EXPECT_EQ(run.metric(vehicle, "contact_count"), 0.0) << vehicle;
      EXPECT_EQ(run.metric(vehicle, "finished"), 1.0) << vehicle;
    }
    EXPECT_GE(run.metric("drone", "min_clearance_m"), 0.3);
  }
}
INSTANTIATE_TEST_SUITE_P(Twenty, ClosedLoopSeeds, ::testing::Values(1, 6, 11, 16));

}  // namespace
}  // namespace vinerow::localisation_mission_test
