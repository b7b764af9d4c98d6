/// Missions on a map that was made of a point cloud: planners, guidance and estimators know the
/// vineyard by it alone.

#include <gtest/gtest.h>

#include "engine/sim/simulation.h"
#include "tests/scenarios/small_vineyard_map.h"
#include "vinerow/testing.h"
#include "worlds/mapping/folder/map_folder.h"

namespace vinerow::cloud_map_mission_test {
namespace {

namespace fs = std::filesystem;
using test::ScratchFolder;
using testing::TestRun;

const std::string kAssets = std::string(VINEROW_SOURCE_DIR) + "/assets/";

std::string rover_with(const std::string& map) {
  return "duration_s: 150\nvehicles:\n  rover:\n    include: " + kAssets +
         "vehicles/rover_paper_a.yaml\n    wheel_probes: 1\n"
         "    spawn: {alley: 0, offset_m: 2.0}\n" +
         map +
         "    sensors:\n      encoders: {type: encoders, rate_Hz: 50}\n"
         "    planner: {type: rrt_star, alleys: [0, 1], margin_m: 0.03, clearance_weight: 0}\n"
         "    guidance: {type: dwa, rate_Hz: 10, speed_mps: 1.0}\n"
         "    controller: {type: four_wheel_steering, rate_Hz: 50, speed_mps: 1.0, "
         "turn_speed_mps: 0.8}\n";
}

/// Paper C's quadrotor on its own estimate, from fixes, inertial unit, echoes and map.
std::string drone_with(const std::string& map) {
  const std::string sensor = "{include: " + kAssets + "sensors/hc_sr04.yaml, ";
  return "duration_s: 60\nvehicles:\n  drone:\n    include: " + kAssets +
         "vehicles/quadrotor_m100.yaml\n    layout: x\n"
         "    spawn: {alley: 0, offset_m: -1.5}\n" +
         map + "    sensors:\n      ins: {include: " + kAssets +
         "sensors/vn200_ins.yaml, rate_Hz: 100}\n"
         "      gps: {type: gps, rate_Hz: 5, horizontal_std_m: 1.0, vertical_std_m: 1.5}\n"
         "      us_fl: " +
         sensor +
         "position_m: [0.23, 0.23, 0.0], rotation_deg: [0, 0, 45]}\n      us_fr: " + sensor +
         "position_m: [0.23, -0.23, 0.0], rotation_deg: [0, 0, -45]}\n      us_rl: " + sensor +
         "position_m: [-0.23, 0.23, 0.0], rotation_deg: [0, 0, 135]}\n      us_rr: " + sensor +
         "position_m: [-0.23, -0.23, 0.0], rotation_deg: [0, 0, -135]}\n      us_down: " + sensor +
         "position_m: [0.0, 0.0, -0.05], rotation_deg: [0, 90, 0]}\n"
         "    estimator: {type: map_localisation, rate_Hz: 100, down: us_down, start_std_m: 0.1}\n"
         "    planner: {type: row_flight, alleys: [0], height_m: 1.3, return_home: false, "
         "turn_speed_mps: 0.8}\n"
         "    guidance: {type: trajectory, rate_Hz: 20, row_speed_mps: 1.5, "
         "lateral_acceleration_mps2: 1.0}\n"
         "    controller: {type: quadrotor_mpc, rate_Hz: 20}\n";
}

class CloudMapMission : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<ScratchFolder>("cloud_map_mission");
    const std::string cloud = test::small_cloud(*folder_);
    const auto result = test::run_vinerow(
        "map " + cloud + " --no-pictures --headland 10 --scenario " +
        (folder_->path() / "world.yaml").string() + " --out " + map_folder().string());
    if (result.status != 0) throw std::runtime_error(result.output);
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static fs::path map_folder() { return folder_->path() / "map"; }
  static std::string cloud_map(const std::string& more = "") {
    return "    map: {type: cloud_map, folder: " + map_folder().string() + more + "}\n";
  }
  static TestRun start(const std::string& name, const std::string& rest) {
    return TestRun::from_file(test::small_scenario(*folder_, name, rest));
  }

  static inline std::unique_ptr<ScratchFolder> folder_;
};

TEST_F(CloudMapMission, TheRoverWorksTwoAlleysAsOnTheTruth) {
  for (const bool on_truth : {true, false}) {
    SCOPED_TRACE(on_truth ? "truth" : "cloud_map");
    TestRun run = start("rover", rover_with(on_truth ? "" : cloud_map()));
    run.run_to_end();
    std::printf("%s: %.0f alleys, %.0f contacts, clearance %.3f m, %.1f s\n",
                on_truth ? "truth" : "cloud_map", run.metric("rover", "alleys_driven"),
                run.metric("rover", "contact_count"), run.metric("rover", "min_clearance_m"),
                run.time_s());
    EXPECT_TRUE(run.finished());
    EXPECT_EQ(run.metric("rover", "alleys_driven"), 2.0);
    EXPECT_EQ(run.metric("rover", "contact_count"), 0.0);
  }
}

TEST_F(CloudMapMission, TheQuadrotorLocalisesItselfOnTheMap) {
  for (const bool survey : {true, false}) {
    SCOPED_TRACE(survey ? "row_mesh" : "cloud_map");
    TestRun run = start(
        "drone", drone_with(survey ? "    map: {type: row_mesh, section_spacing_m: [0.4, 0.5], "
                                     "stated_surface_std_m: 0.03}\n"
                                   : cloud_map(", stated_surface_std_m: 0.03")));
    run.run_to_end();
    std::printf("%s: lateral %.3f m, longitudinal %.3f m, clearance %.3f m\n",
                survey ? "row_mesh" : "cloud_map", run.metric("drone", "estimate_lateral_rms_m"),
                run.metric("drone", "estimate_longitudinal_rms_m"),
                run.metric("drone", "min_clearance_m"));
    EXPECT_TRUE(run.finished());
    EXPECT_EQ(run.metric("drone", "alleys_driven"), 1.0);
    EXPECT_EQ(run.metric("drone", "contact_count"), 0.0);
    EXPECT_GE(run.metric("drone", "min_clearance_m"), 0.3);
  }
}

TEST_F(CloudMapMission, PlannersTakeTheGroundFromTheMap) {
  const auto heights = [&](const std::string& name) {
    TestRun run = start(name, rover_with(cloud_map()));
    run.run_for_s(0.1);
    std::vector<double> z;
    for (const PathPoint& point : run.signal<PlannedPath>("rover/plan").points) {
      z.push_back(point.p_W.z());
    }
    return z;
  };
  const std::vector<double> before = heights("before");
  ASSERT_GT(before.size(), 20u);
  const mapping::CloudMap map = mapping::load_map(map_folder());
  mapping::CloudMap raised = map;
  for (float& z : raised.map.terrain->heights_m) z += 1.5f;
  mapping::save_map(raised, map_folder());
  const std::vector<double> after = heights("after");
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t k = 0; k < after.size(); ++k) EXPECT_NEAR(after[k] - before[k], 1.5, 1e-4);

  // Farther beyond the map's terrain nobody knows the ground, even where the world goes on.
  raised = map;
  HeightField& terrain = *raised.map.terrain;
  const HeightField whole = terrain;
  terrain.columns = whole.columns / 4;
  terrain.heights_m.clear();
  for (int j = 0; j < terrain.rows; ++j) {
    for (int i = 0; i < terrain.columns; ++i) {
      terrain.heights_m.push_back(whole.heights_m[static_cast<std::size_t>(j) * whole.columns + i]);
    }
  }
  mapping::save_map(raised, map_folder());
  try {
    heights("half");
    ADD_FAILURE() << "planned over ground that the map does not have";
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("path leaves the ground"), std::string::npos)
        << error.what();
  }
  mapping::save_map(map, map_folder());
}

}  // namespace
}  // namespace vinerow::cloud_map_mission_test
