/// Paper A, section 4.1, whole: the four-wheel-steering rover on Parcel F under full physics.

#include <gtest/gtest.h>

#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/sim/simulation.h"
#include "tests/scenarios/command.h"
#include "vinerow/testing.h"

namespace vinerow::four_wheel_mission_test {
namespace {

using test::run_vinerow;
using test::scenario_file;
using test::ScratchFolder;
using testing::TestRun;

constexpr double kNotReported = -1.0;

/// Keeps the events of the run.
struct EventRecorder : RunObserver {
  std::vector<Event> events;
  void on_event(Time, const Event& event) override { events.push_back(event); }

  int count(const std::string& source, const std::string& text) const {
    return static_cast<int>(std::count_if(events.begin(), events.end(), [&](const Event& event) {
      return event.source == source && event.text.find(text) != std::string::npos;
    }));
  }
};

double planning_number(TestRun& run, const std::string& name) {
  const auto all = run.simulation().planning();
  const auto found = all.at("rover").find(name);
  return found == all.at("rover").end() ? kNotReported : found->second;
}

/// The limits: no contact, 0.02 m rms in rows, 0.05 m rms in turns, with true pose.
void expect_mission_within_limits(TestRun& run, double alleys) {
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.metric("rover", "alleys_driven"), alleys);
  EXPECT_EQ(run.metric("rover", "contact_count"), 0.0);
  EXPECT_LE(run.metric("rover", "cross_track_rms_m"), 0.02);
  EXPECT_LE(run.metric("rover", "turn_deviation_rms_m"), 0.05);
  for (const char* name : {"cross_track_rms_m", "turn_deviation_rms_m", "slip_rms_turn"}) {
    ::testing::Test::RecordProperty(name, std::to_string(run.metric("rover", name)));
  }
}

TEST(FourWheelMission, TwoRowsWithTheTurn) {
  TestRun run = TestRun::from_file(scenario_file("vineyard_4ws_two_rows"));
  run.run_to_end();
  expect_mission_within_limits(run, 2.0);
  EXPECT_EQ(planning_number(run, "turns"), 1.0);
  EXPECT_GT(planning_number(run, "nodes"), 0.0);
  EXPECT_GE(planning_number(run, "clearance_m"), 0.03);
  // 2 x 118 m, 2 m of approach, and not less than the omega turn of 9.42 m (reference: radius 1.767
  // m).
  EXPECT_NEAR(planning_number(run, "length_m"), 2 * 118.0 + 2.0 + 9.42, 0.5);
  EXPECT_GE(planning_number(run, "turn_length_m"), 9.42);
}

TEST(FourWheelMission, QpSpeedsSlipAThirdOfEqualSpeedsInTheTurn) {
  const auto slip = [](const std::string& speeds) {
    TestRun run = TestRun::from_file(
        scenario_file("vineyard_4ws_two_rows"),
        {"rover.controller.speeds=" + speeds, "rover.guidance=null", "duration_s=145"});
    run.run_to_end();
    for (const char* wheel : {"fl", "fr", "rl", "rr"}) {
      EXPECT_GE(run.metric("rover", std::string("slip_max_") + wheel),
                run.metric("rover", std::string("slip_rms_") + wheel));
    }
    return run.metric("rover", "slip_rms_turn");
  };
  const double qp = slip("qp"), equal = slip("equal");
  EXPECT_LE(qp, equal / 3.0);
  RecordProperty("slip_rms_turn_qp", std::to_string(qp));
  RecordProperty("slip_rms_turn_equal", std::to_string(equal));
}

TEST(FourWheelMission, AllSixteenRows) {
  TestRun run = TestRun::from_file(scenario_file("vineyard_4ws_parcel"));
  run.run_to_end();
  expect_mission_within_limits(run, 15.0);
  EXPECT_GE(run.metric("rover", "battery_hours"), 8.0);
}

TEST(FourWheelMission, ThePapersOwnPlannerDrivesTwoRows) {
  TestRun run = TestRun::from_file(scenario_file("vineyard_4ws_two_rows"),
                                   {"rover.planner={type: rrt_quartile, alleys: [0, 1]}"});
  run.run_to_end();
  expect_mission_within_limits(run, 2.0);
}

TEST(FourWheelMission, PassesACrateAndStopsBeforeAPallet) {
  TestRun run = TestRun::from_file(scenario_file("vineyard_4ws_obstacle"));
  EventRecorder recorder;
  run.simulation().add_observer(&recorder);
  run.run_to_end();
  EXPECT_EQ(run.metric("rover", "contact_count"), 0.0);
  EXPECT_EQ(run.metric("rover", "alleys_driven"), 1.0);
  EXPECT_FALSE(run.finished());
  EXPECT_EQ(recorder.count("rover.guidance", "sees an obstacle that the map does not have"), 2);
  EXPECT_GE(recorder.count("rover.guidance", "follows the plan again"), 1);
  EXPECT_EQ(recorder.count("rover.guidance", "blocked at"), 1);
  // It waits before the pallet: hull and pallet reach 0.75 m and 0.6 m along the alley.
  for (const MeshInstance& mesh : run.simulation().world().meshes) {
    if (mesh.name != "obstacle/pallet") continue;
    const double away_m = (run.truth("rover").X_WB.p - mesh.X_WM.p).head<2>().norm();
    EXPECT_GT(away_m, 1.35);
    EXPECT_LT(away_m, 5.0);
    return;
  }
  FAIL() << "the world has no pallet";
}

TEST(FourWheelMission, SameDigestTwiceAndAnotherSeedAnotherTree) {
  const auto digest = [](const std::string& seed) {
    TestRun run = TestRun::from_file(scenario_file("vineyard_4ws_two_rows"),
                                     {"duration_s=10", "seed=" + seed});
    run.run_to_end();
    return run.digest();
  };
  const std::string first = digest("1");
  EXPECT_EQ(first, digest("1"));
  EXPECT_NE(first, digest("2"));
}

TEST(FourWheelMission, AnInfeasibleQpStopsTheRoverAndIsTold) {
  // Wheels that may change their speed so slowly cannot follow the steering into the turn.
  TestRun run = TestRun::from_file(
      scenario_file("vineyard_4ws_two_rows"),
      {"rover.controller.wheel_acceleration_mps2=0.51", "rover.guidance=null", "duration_s=150"});
  EventRecorder recorder;
  run.simulation().add_observer(&recorder);
  run.run_to_end();
  ASSERT_EQ(recorder.count("rover.controller", "wheel speed"), 1);
  EXPECT_FALSE(run.finished());
  EXPECT_LT(run.truth("rover").v_WB_B.norm(), 1e-3);
  EXPECT_EQ(run.metric("rover", "contact_count"), 0.0);
}

/// Status 2 and one line that holds each of the texts.
void expect_refused(const std::string& set, const std::vector<std::string>& texts) {
  const ScratchFolder folder("four_wheel_refused");
  const auto result =
      run_vinerow("run " + scenario_file("vineyard_4ws_two_rows") + " --quiet --no-log --out " +
                  folder.path().string() + " --set '" + set + "'");
  EXPECT_EQ(result.status, 2) << set << "\n" << result.output;
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  for (const std::string& text : texts) {
    EXPECT_NE(result.output.find(text), std::string::npos) << "wanted: " << text << "\n"
                                                           << result.output;
  }
}

TEST(FourWheelMission, RefusesWhatCannotBePlanned) {
  expect_refused(
      "rover.spawn={x_m: 60, y_m: 18.5, yaw_deg: 10}",
      {"vehicles.rover.spawn", "the vehicle would stand in the canopy", "'alley: 0' to"});
  expect_refused(
      "world.obstacles=[{name: wall, alley: 1, distance_m: 60, size_m: [0.5, 2.4, 1], mapped: "
      "true}]",
      {"the leg in alley 1 is blocked"});
  expect_refused(
      "rover.planner={type: rrt_quartile, alleys: [0, 1], steering: two_wheel, "
      "steering_angle_deg: 30}",
      {"the turn from alley 0 to alley 1 needs 0.79 m more clearance", "turning radius of 2.60 m",
       "tree exhausted"});
  expect_refused("rover.planner.margin_m=0.3", {"needs 0.2", "m more clearance", "1.77 m"});
  expect_refused("world.occupancy_cell_m=0", {"no occupancy grid", "occupancy_cell_m"});
}

}  // namespace
}  // namespace vinerow::four_wheel_mission_test
