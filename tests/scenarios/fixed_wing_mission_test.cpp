/// Paper A, section 2, whole: the flying wing surveys the hillside under full physics. In wind of
/// at most 1 m/s tube-based MPC leaves no limit, whatever the seed; others do where it counts.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/sim/judge.h"
#include "engine/sim/simulation.h"
#include "tests/scenarios/command.h"
#include "tests/scenarios/seeds.h"
#include "tests/support/data.h"
#include "tests/support/paths.h"
#include "vinerow/testing.h"

namespace vinerow::fixed_wing_mission_test {
namespace {

using test::scenario_file;
using testing::TestRun;
using Sets = std::vector<std::string>;

constexpr const char* kSamplePlan =
    "mavsdk/cpp/src/mavsdk/plugins/mission_raw/test_plans/qgroundcontrol_sample.plan";

/// The two outermost rows hold the hillside where the scenario's rows have it. Vines, posts and
/// leaves below an aircraft at 150 m only take time to plant.
/// @param row_count  of the scenario, 2.5 m apart
Sets on_two_rows(int row_count, const Sets& more) {
  Sets sets{"world.row_count=2",         "world.pitch_m=" + std::to_string(2.5 * (row_count - 1)),
            "world.vine_spacing_m=20",   "world.canopy_step_m=5",
            "world.leaf_cards_per_m=10", "world.plant_variants=1",
            "world.posts=false"};
  sets.insert(sets.end(), more.begin(), more.end());
  return sets;
}

TestRun survey(const std::string& scenario, const Sets& more = {}) {
  return TestRun::from_file(scenario_file(scenario), on_two_rows(48, more));
}

/// Ticks outside the limits of one axis' states or inputs, all four.
struct Outside {
  double lon_states, lon_inputs, lat_states, lat_inputs;

  explicit Outside(const TestRun& run)
      : lon_states(run.metric("plane", "limit_steps_lon_states")),
        lon_inputs(run.metric("plane", "limit_steps_lon_inputs")),
        lat_states(run.metric("plane", "limit_steps_lat_states")),
        lat_inputs(run.metric("plane", "limit_steps_lat_inputs")) {}
  double inputs() const { return lon_inputs + lat_inputs; }
  double all() const { return lon_states + lat_states + inputs(); }
};

void expect_criteria_met(TestRun& run) {
  const auto verdicts = judge(run.simulation().scenario().criteria, run.simulation().metrics());
  EXPECT_GE(verdicts.size(), 12u);
  for (const CriterionResult& verdict : verdicts) {
    EXPECT_TRUE(verdict.met) << verdict.name << ": " << verdict.metric << " = " << verdict.value
                             << ", limit " << verdict.limit;
    ::testing::Test::RecordProperty(verdict.metric, std::to_string(verdict.value));
  }
}

/// Limits of errors in wind of at most 1 m/s. Every seed keeps them, and so all of them together.
const std::map<std::string, double> kTracking = {{"height_error_rms_m", 0.7},
                                                 {"straight_cross_track_rms_m", 0.75},
                                                 {"heading_error_rms_deg", 2.6}};

/// Fifty seeds: other wind each time, from the launch to the landing.
class FixedWingMissionSeeds : public ::testing::TestWithParam<int> {};

TEST_P(FixedWingMissionSeeds, SurveyInWindLeavesNoLimit) {
  const int seeds = test::seeds_of_group(10);
  std::map<std::string, double> squares, worst;
  for (int seed = GetParam(); seed < GetParam() + seeds; ++seed) {
    SCOPED_TRACE(seed);
    TestRun run = survey("survey_turbulence",
                         {"seed=" + std::to_string(seed),
                          "metrics={air_tracking: {type: air_tracking}, flight: {type: flight}, "
                          "path_deviation: {type: path_deviation}, travel: {type: travel}}",
                          "criteria=[]"});
    run.run_to_end();
    EXPECT_TRUE(run.finished());
    EXPECT_EQ(run.metric("plane", "crashed"), 0.0);
    EXPECT_EQ(run.metric("plane", "alleys_driven"), 10.0);
    EXPECT_EQ(Outside(run).all(), 0.0);
    for (const auto& [name, limit] : kTracking) {
      const double rms = run.metric("plane", name);
      EXPECT_LE(rms, limit) << name;
      squares[name] += rms * rms;
      worst[name] = std::max(worst[name], rms);
    }
    EXPECT_GT(run.metric("plane", "height_error_rms_m"), 0.3) << "the wind is felt";
    std::printf("seed %2d: height %.3f m, cross-track %.3f m, heading %.2f deg, limits used %.2f\n",
                seed, run.metric("plane", "height_error_rms_m"),
                run.metric("plane", "straight_cross_track_rms_m"),
                run.metric("plane", "heading_error_rms_deg"),
                run.metric("plane", "limit_share_max"));
  }
  for (const auto& [name, sum] : squares) {
    const double rms = std::sqrt(sum / seeds);
    RecordProperty(name, std::to_string(rms));
    RecordProperty("worst_" + name, std::to_string(worst[name]));
    std::printf("%s: %.3f of %d seeds, worst %.3f\n", name.c_str(), rms, seeds, worst[name]);
  }
}
INSTANTIATE_TEST_SUITE_P(Fifty, FixedWingMissionSeeds, ::testing::Values(1, 11, 21, 31, 41));

TEST(FixedWingMission, SurveyInStillAirMeetsAllItsCriteria) {
  TestRun run = survey("survey_still");
  run.run_to_end();
  expect_criteria_met(run);
}

TEST(FixedWingMission, SurveyInWindMeetsAllItsCriteria) {
  TestRun run = survey("survey_turbulence");
  run.run_to_end();
  expect_criteria_met(run);
}

TEST(FixedWingMission, OneSeedHasOneDigest) {
  const auto digest = [](int seed) {
    TestRun run = survey("survey_turbulence", {"seed=" + std::to_string(seed)});
    return run.run_for_s(90.0).digest();
  };
  EXPECT_EQ(digest(1), digest(1));
  EXPECT_NE(digest(1), digest(2));
}

TEST(FixedWingMission, FliesAMissionOfQGroundControlAndLands) {
  VINEROW_OUTSIDE_DATA(file, kSamplePlan);
  TestRun run = TestRun::from_yaml(
      "vinerow: 1\nname: sample\nseed: 1\nduration_s: 300\nphysics: {step_s: 0.0025}\n"
      "world: {type: vineyard, row_count: 2, row_length_m: 20, relief_m: 0, surroundings_m: 700, "
      "terrain_cell_m: 4, occupancy_cell_m: 0, origin_latitude_deg: 47.3977507, "
      "origin_longitude_deg: 8.5456075}\nvehicles:\n  plane:\n"
      "    include: assets/vehicles/mh900_like.yaml\n"
      "    spawn: {x_m: -300, y_m: 0, yaw_deg: 0}\n"
      "    planner: {type: mission_file, file: '" +
          std::filesystem::absolute(file).string() +
          "'}\n    guidance: {type: waypoint_guidance, land_at_m: [100, -100], land_height_m: 0, "
          "land_bearing_deg: 90}\n    controller: {type: trmpc}\n",
      VINEROW_SOURCE_DIR);
  // The file's waypoints from its take-off, at 111.32 km a degree of latitude.
  const std::vector<Eigen::Vector3d> waypoints = {{75.7, 2.3, 50}, {75.2, 58.2, 50}, {0, 58.7, 50}};
  std::vector<double> nearest_m(waypoints.size(), 1e9);
  while (!run.finished() && run.time_s() < 299.0) {
    run.run_for_s(0.1);
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      const double away_m = (run.truth("plane").X_WB.p - waypoints[i]).norm();
      nearest_m[i] = std::min(nearest_m[i], away_m);
    }
  }
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.metric("plane", "crashed"), 0.0);
  EXPECT_EQ(Outside(run).all(), 0.0);
  // Corners of 90 deg are cut: by R (sqrt(2) - 1) = 13.6 m at the file's 15 m/s and 35 deg.
  for (const double away_m : nearest_m) EXPECT_LT(away_m, 16.0);
  EXPECT_NEAR((run.truth("plane").X_WB.p - Eigen::Vector3d(100, -100, 0)).norm(), 0.0, 25.0);
}

TEST(FixedWingMission, WhatHasEndedInTheAirStaysThereWhileOthersFly) {
  const auto plane = [](const std::string& name, double x_m, double to_m, const std::string& end) {
    const std::string x = std::to_string(x_m);
    return "  " + name + ":\n    include: assets/vehicles/mh900_like.yaml\n    spawn: {x_m: " + x +
           ", y_m: -200, yaw_deg: 90}\n    launch: air\n    start_height_m: 60\n" +
           "    planner: {type: waypoints, x_m: [" + x + ", " + x + "], y_m: [-200, " +
           std::to_string(to_m) + "], z_m: [60, 60]}\n" +
           "    guidance: {type: waypoint_guidance, " + end + "}\n    controller: {type: trmpc}\n";
  };
  TestRun run = TestRun::from_yaml(
      "vinerow: 1\nname: ends\nseed: 1\nduration_s: 120\nphysics: {step_s: 0.0025}\n"
      "world: {type: vineyard, row_count: 2, row_length_m: 20, relief_m: 0, surroundings_m: 600, "
      "terrain_cell_m: 4, occupancy_cell_m: 0}\nvehicles:\n" +
          plane("stops", -100.0, -80.0, "end: stop") +
          plane("circles", 100.0, -80.0, "end: loiter, loiter_s: 10") +
          plane("flies", 0.0, 600.0, "end: stop"),
      VINEROW_SOURCE_DIR);
  run.run_for_s(30.0);
  EXPECT_FALSE(run.finished());
  EXPECT_EQ(run.metric("stops", "finished"), 1.0);
  run.run_to_end();
  EXPECT_TRUE(run.finished());
  EXPECT_NEAR(run.time_s(), 800.0 / 12.0, 2.0);
  for (const auto& [name, x_m] : {std::pair{"stops", -100.0}, {"circles", 100.0}}) {
    const Eigen::Vector3d away = run.truth(name).X_WB.p - Eigen::Vector3d(x_m, -80.0, 60.0);
    EXPECT_EQ(run.metric(name, "crashed"), 0.0) << name;
    EXPECT_EQ(run.metric(name, "finished"), 1.0) << name;
    EXPECT_NEAR(away.z(), 0.0, 1.0) << name;
    // 1.5 radii of a turn at 35 deg of bank and 12 m/s.
    EXPECT_NEAR(away.head<2>().norm(), 31.5, 3.0) << name;
  }
}

/// 14 m too low and 24 deg off: @returns ticks outside limits under a controller
Outside stress(int seed, const Sets& controller) {
  Sets sets = on_two_rows(16, {"seed=" + std::to_string(seed)});
  sets.insert(sets.end(), controller.begin(), controller.end());
  TestRun run = TestRun::from_file(scenario_file("trmpc_stress"), sets);
  run.run_to_end();
  EXPECT_EQ(run.metric("plane", "crashed"), 0.0);
  return Outside(run);
}

/// Seeds 1 to 3, printed on the console and recorded in the report.
std::vector<Outside> stresses(const std::string& name, const Sets& controller) {
  std::vector<Outside> seeds;
  for (int seed = 1; seed <= 3; ++seed) {
    const Outside outside = stress(seed, controller);
    const std::string text =
        std::to_string(static_cast<int>(outside.lon_states)) + " longitudinal states, " +
        std::to_string(static_cast<int>(outside.lon_inputs)) + " inputs, " +
        std::to_string(static_cast<int>(outside.lat_states)) + " lateral states, " +
        std::to_string(static_cast<int>(outside.lat_inputs)) + " inputs";
    std::printf("%s, seed %d: ticks outside: %s\n", name.c_str(), seed, text.c_str());
    ::testing::Test::RecordProperty(name + "_" + std::to_string(seed), text);
    seeds.push_back(outside);
  }
  return seeds;
}

TEST(FixedWingMissionStress, TheTubeLeavesNoLimit) {
  for (const Outside& outside : stresses("trmpc", {})) EXPECT_EQ(outside.all(), 0.0);
}

TEST(FixedWingMissionStress, TheLqrLeavesStatesAndInputs) {
  for (const Outside& outside : stresses("lqr", {"plane.controller={type: fixed_wing_lqr}"})) {
    EXPECT_GT(outside.lon_states, 0.0);
    EXPECT_GT(outside.lon_inputs, 0.0);
  }
}

TEST(FixedWingMissionStress, TheLawAsPrintedLeavesInputs) {
  for (const Outside& outside : stresses("printed", {"plane.controller.law=printed"})) {
    EXPECT_GT(outside.inputs(), 0.0);
  }
}

TEST(FixedWingMissionStress, ThePidLeavesTheAileron) {
  for (const Outside& outside : stresses("pid", {"plane.controller={type: fixed_wing_pid}"})) {
    EXPECT_GT(outside.lat_inputs, 0.0);
  }
}

TEST(FixedWingMissionStress, WithoutATubeNothingIsPromised) {
  // Limits of inputs are hard in it as well. Those of states give way, if not with every seed.
  double states = 0.0;
  for (const Outside& outside : stresses("nominal", {"plane.controller={type: mpc_nominal}"})) {
    EXPECT_EQ(outside.inputs(), 0.0);
    states += outside.lon_states;
  }
  EXPECT_GT(states, 0.0);
  stresses("fixed_start", {"plane.controller.law=fixed_start"});
}

}  // namespace
}  // namespace vinerow::fixed_wing_mission_test
