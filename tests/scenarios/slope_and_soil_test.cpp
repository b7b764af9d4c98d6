/// The four-wheel-steering rover's scenarios beside paper A's: standing on a slope, turning on wet
/// soil.

#include <gtest/gtest.h>

#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "engine/sim/simulation.h"
#include "tests/scenarios/command.h"
#include "vinerow/testing.h"

namespace vinerow::slope_and_soil_test {
namespace {

using testing::TestRun;

TEST(SlopeHold, StandsOnTwentyDegreesForAMinute) {
  TestRun run = TestRun::from_file(test::scenario_file("slope_hold"));
  run.run_to_end();
  EXPECT_GE(run.time_s(), 63.0);
  EXPECT_LT(run.metric("rover", "standing_drift_m"), 1e-3);
  EXPECT_EQ(run.metric("rover", "contact_count"), 0.0);
  // The file says 20 deg: the ground under the rover, from the height field itself.
  const Eigen::Vector3d& p = run.truth("rover").X_WB.p;
  const Eigen::Vector3d n = run.simulation().world().terrain->normal_W(p.x(), p.y());
  EXPECT_NEAR(deg_from_rad(std::acos(n.z())), 20.0, 0.2);
  RecordProperty("standing_drift_nm",
                 std::to_string(1e9 * run.metric("rover", "standing_drift_m")));
}

TEST(WetSoilTurn, TurnsWithinItsLimitsAndSlipsAThirdOfWhatEqualWheelSpeedsDo) {
  const auto drive = [](const std::string& speeds) {
    TestRun run = TestRun::from_file(test::scenario_file("wet_soil_turn"),
                                     {"rover.controller.speeds=" + speeds});
    run.run_to_end();
    EXPECT_TRUE(run.finished()) << speeds;
    EXPECT_EQ(run.simulation().world().soil.name, "wet_soil");
    return run.metrics("rover");
  };
  std::map<std::string, double> qp = drive("qp"), equal = drive("equal");
  EXPECT_EQ(qp["alleys_driven"], 2.0);
  EXPECT_EQ(qp["contact_count"], 0.0);
  EXPECT_LE(qp["cross_track_rms_m"], 0.02);
  EXPECT_LE(qp["turn_deviation_rms_m"], 0.05);
  EXPECT_LE(qp["slip_rms_turn"], equal["slip_rms_turn"] / 3.0);
  RecordProperty("slip_rms_turn_qp", std::to_string(qp["slip_rms_turn"]));
  RecordProperty("slip_rms_turn_equal", std::to_string(equal["slip_rms_turn"]));
}

}  // namespace
}  // namespace vinerow::slope_and_soil_test
