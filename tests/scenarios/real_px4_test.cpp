// Vehicles under PX4 itself: with $VINEROW_PX4, its build folder. The criteria of the scenario are
// the expectations. PX4 does not repeat to the bit; its recording does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/scenarios/command.h"

namespace vinerow::real_px4_test {
namespace {

using test::run_vinerow;
using test::ScratchFolder;
using test::value_in;

const std::string kFleet = VINEROW_SOURCE_DIR "/assets/autopilots/px4_fleet.yaml";
constexpr const char* kMissing = "VINEROW_PX4 names no build folder of PX4";

bool has_firmware() {
  const char* folder = std::getenv("VINEROW_PX4");
  return folder != nullptr && std::filesystem::exists(std::filesystem::path(folder) / "bin/px4");
}

std::string only_the_drone() {
  return " --set criteria=[] --set phases=null --set vehicles.rover=null --set vehicles.plane=null"
         " --set pictures=null --no-report";
}

TEST(RealPx4, ItsScenarioIsValidWithoutIt) {
  const auto checked = run_vinerow("validate " + kFleet);
  EXPECT_EQ(checked.status, 0) << checked.output;
}

TEST(RealPx4, RoverCopterAndPlaneMeetTheCriteriaTogether) {
  if (!has_firmware()) GTEST_SKIP() << kMissing;
  const ScratchFolder folder("real_px4_fleet");
  const auto run = run_vinerow("run " + kFleet + " --no-pictures --no-report --out " +
                               (folder.path() / "run").string());
  EXPECT_EQ(run.status, 0) << run.output;
  std::printf("%s\n", value_in(run.output, "simulated").c_str());
}

TEST(RealPx4, ItsRecordingGivesTheSameDigest) {
  if (!has_firmware()) GTEST_SKIP() << kMissing;
  const ScratchFolder folder("real_px4_replay");
  const std::string out = (folder.path() / "run").string();
  const std::string options = "run " + kFleet + only_the_drone();
  const auto run = run_vinerow(options + " --set drone.autopilot.record=x.pcap --out " + out);
  ASSERT_EQ(run.status, 0) << run.output;
  const auto replay = run_vinerow(
      options +
      " --set 'drone.autopilot={type: replay, rate_Hz: 250, imu: imu, magnetometer: compass, "
      "barometer: barometer, gnss: gnss, file: " +
      out + "/products/drone.autopilot/x.pcap}' --out " + out + "_replay");
  EXPECT_EQ(value_in(replay.output, "digest"), value_in(run.output, "digest")) << replay.output;
}

TEST(RealPx4, ParametersThatItDoesNotKnowAreNamed) {
  if (!has_firmware()) GTEST_SKIP() << kMissing;
  const ScratchFolder folder("real_px4_other");
  const auto run = run_vinerow("run " + kFleet + only_the_drone() +
                               " --set 'drone.autopilot.parameters=[{name: NO_SUCH, value: 1}]'"
                               " --out " +
                               (folder.path() / "run").string());
  EXPECT_NE(run.status, 0);
  EXPECT_THAT(run.output, ::testing::HasSubstr("the autopilot has no parameter NO_SUCH"));
}

}  // namespace
}  // namespace vinerow::real_px4_test
