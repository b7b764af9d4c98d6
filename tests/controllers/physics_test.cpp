// The followers on the physical rover in the surveyed vineyard: all nine alleys and eight hairpins
// of 1.25 m. The limits are those the project promises (0.05 m and 0.08 m on legs), halved where
// there is room.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/paths.h"
#include "vinerow/testing.h"

namespace vinerow::test {
namespace {

std::map<std::string, double> drive(const std::vector<std::string>& sets) {
  auto run = vinerow::testing::TestRun::from_file(
      std::string(VINEROW_SOURCE_DIR) + "/assets/scenarios/riseholme_rover.yaml", sets);
  run.run_to_end();
  EXPECT_TRUE(run.finished());
  return run.metrics("rover");
}

void expect_good(const std::vector<std::string>& sets, double leg_rms_m) {
  const auto metrics = drive(sets);
  EXPECT_EQ(metrics.at("alleys_driven"), 9.0);
  EXPECT_EQ(metrics.at("contact_count"), 0.0);
  EXPECT_LT(metrics.at("cross_track_rms_m"), leg_rms_m);
  EXPECT_GT(metrics.at("min_clearance_m"), 0.15);
}

const std::string kGps = "rover.estimator.type=gps_pose";
const std::string kFilter = "rover.estimator.type=odometry_filter";

TEST(PathFollowerOnThePhysicalRover, KeepsTheLegsWithTruePose) {
  expect_good({}, 0.02);
}

TEST(PathFollowerOnThePhysicalRover, KeepsTheLegsWithRtkAndNoFilter) {
  expect_good({kGps}, 0.03);
  expect_good({kGps, "rover.sensors.gps.rate_Hz=10"}, 0.04);
}

TEST(PathFollowerOnThePhysicalRover, KeepsTheLegsWithTheFilters) {
  expect_good({kFilter, "rover.estimator.odometry_source=gps_velocity"}, 0.03);
  expect_good({kFilter, "rover.estimator.odometry_source=wheels",
               "rover.estimator.drift_m_per_sqrt_m=0.05"},
              0.04);
}

TEST(PathFollowerOnThePhysicalRover, DrivesWithGyroAndCourse) {
  expect_good({kGps, "rover.estimator.heading=gyro_course", "rover.sensors.gps.error=gaussian"},
              0.06);
}

TEST(PathFollowerOnThePhysicalRover, DrivesDubinsTurnsAndSkips) {
  expect_good({"rover.planner.turn=dubins", "rover.planner.turn_radius_m=1.25"}, 0.03);
  expect_good({"rover.planner.order=skip"}, 0.03);
}

}  // namespace
}  // namespace vinerow::test
