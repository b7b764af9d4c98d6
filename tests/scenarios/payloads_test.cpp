/// A rover sprays two alleys of a small vineyard and a camera on it looks at the rows, whole runs
/// under full physics: what the payloads' results and files say of it.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/paths.h"
#include "vinerow/testing.h"

namespace vinerow::payloads_test {
namespace {

using testing::TestRun;

constexpr double kRow_m = 30.0;
constexpr double kSpeed_mps = 1.0;

TestRun make_run(const std::string& payloads) {
  const std::string yaml = R"(
vinerow: 1
seed: 3
duration_s: 150
physics: {step_s: 0.002}
world: {type: vineyard, row_count: 3, row_length_m: 30, relief_m: 0, missing_vine_share: 0}
vehicles:
  rover:
    include: ../vehicles/rover_paper_b.yaml
    spawn: {alley: 0, offset_m: 3}
    planner: {type: coverage, waypoint_pitch_m: 0.25, turn: three_point_arc, headland_m: 4.5}
    controller: {type: path_follower, rate_Hz: 50, speed_mps: 1.0, turn_rate_radps: 0.3, lookahead_min_m: 1.0}
)" + payloads;
  return TestRun::from_yaml(yaml, std::string(VINEROW_SOURCE_DIR) + "/assets/scenarios");
}

TEST(Payloads, ARoverSpraysItsRowsAndLooksAtThem) {
  TestRun run = make_run(R"(
    payloads:
      sprayer: {type: sprayer, boom_x_m: 0}
      scout: {type: canopy_camera, position_m: [0, 0, 1.0], wanted_gsd_mm: 1.0}
)");
  run.run_to_end();
  ASSERT_TRUE(run.finished());
  const auto result = [&](const std::string& name) { return run.metric("rover", name); };
  // Two alleys, and closed on the headland between them.
  EXPECT_NEAR(result("sprayer_spray_time_s"), 2.0 * kRow_m / kSpeed_mps, 3.0);
  // Eight nozzles of 0.2 l/min at 4 instead of 3 bar.
  const double flow_lps = 8.0 * 0.2 / 60.0 * std::sqrt(4.0 / 3.0);
  EXPECT_NEAR(result("sprayer_litres_sprayed"), flow_lps * result("sprayer_spray_time_s"),
              0.02 * result("sprayer_litres_sprayed"));
  EXPECT_NEAR(result("sprayer_litres_canopy") + result("sprayer_litres_ground") +
                  result("sprayer_litres_lost"),
              result("sprayer_litres_sprayed"), 1e-9);
  EXPECT_LT(result("sprayer_litres_off_row"), 0.02 * result("sprayer_litres_sprayed"));
  EXPECT_NEAR(result("sprayer_litres_per_ha"), 1e4 * flow_lps / (kSpeed_mps * 2.5), 8.0);
  // Four of the six sides of three rows.
  EXPECT_NEAR(result("sprayer_worked_share"), 4.0 / 6.0, 0.03);
  EXPECT_GT(result("sprayer_worked_covered_share"), 0.5);
  EXPECT_LE(result("sprayer_covered_share"), 1.0);
  EXPECT_GT(result("scout_seen_share"), 0.3);
  EXPECT_LT(result("scout_gsd_mean_mm"), 1.0);
  for (const char* name :
       {"sprayer_on_target_share", "sprayer_worked_covered_share", "sprayer_covered_share",
        "sprayer_worked_deposit_cv", "scout_seen_share"}) {
    RecordProperty(name, std::to_string(result(name)));
  }
}

TEST(Payloads, DoNotDisturbTheVehicleAndRepeat) {
  const std::string sprayer = "    payloads: {sprayer: {type: sprayer}}\n";
  TestRun with = make_run(sprayer), again = make_run(sprayer);
  TestRun without = make_run("");
  for (TestRun* run : {&with, &again, &without}) run->run_for_s(10.0);
  EXPECT_EQ(with.digest(), again.digest());
  EXPECT_EQ((with.truth("rover").X_WB.p - without.truth("rover").X_WB.p).norm(), 0.0);
}

}  // namespace
}  // namespace vinerow::payloads_test
