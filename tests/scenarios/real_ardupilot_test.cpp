// Vehicles under ArduPilot itself: with $VINEROW_ARDUPILOT, a folder with ardurover, arducopter and
// arduplane. The criteria of the scenario are the expectations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/scenarios/command.h"
#include "vinerow/session.h"

namespace vinerow::real_ardupilot_test {
namespace {

using test::run_vinerow;
using test::ScratchFolder;
using test::value_in;

const std::string kFleet = VINEROW_SOURCE_DIR "/assets/autopilots/orchard_fleet.yaml";

bool has_firmware() {
  const char* folder = std::getenv("VINEROW_ARDUPILOT");
  return folder != nullptr && std::filesystem::exists(std::filesystem::path(folder) / "ardurover");
}

/// The fleet with one vehicle, and its own criteria.
std::string only(const std::string& vehicle) {
  std::string options = " --set criteria=[] --set phases=null";
  for (const char* other : {"rover", "drone", "plane"}) {
    if (other != vehicle) options += " --set vehicles." + std::string(other) + "=null";
  }
  return options + " --set pictures=null --no-report";
}

TEST(RealArdupilot, ItsScenarioIsValidWithoutIt) {
  const auto checked = run_vinerow("validate " + kFleet);
  EXPECT_EQ(checked.status, 0) << checked.output;
}

TEST(RealArdupilot, RoverCopterAndPlaneMeetTheCriteriaTogetherTwice) {
  if (!has_firmware()) GTEST_SKIP() << "VINEROW_ARDUPILOT names no folder with ardurover";
  const ScratchFolder folder("real_fleet");
  const auto run = run_vinerow("run " + kFleet + " --no-pictures --no-report --out " +
                               (folder.path() / "run").string());
  EXPECT_EQ(run.status, 0) << run.output;
  const auto again = run_vinerow("run " + kFleet + " --no-pictures --no-report --out " +
                                 (folder.path() / "again").string());
  EXPECT_EQ(value_in(again.output, "digest"), value_in(run.output, "digest"));
  std::printf("%s\n", value_in(run.output, "simulated").c_str());
}

TEST(RealArdupilot, TwoRunsAndTheReplayAreEqualToTheBit) {
  if (!has_firmware()) GTEST_SKIP() << "VINEROW_ARDUPILOT names no folder with ardurover";
  const ScratchFolder folder("real_rover");
  const std::string out = (folder.path() / "run").string();
  const std::string options = "run " + kFleet + only("rover") + " --set duration_s=150";
  const auto first = run_vinerow(options + " --set rover.autopilot.record=x.pcap --out " + out);
  const auto second = run_vinerow(options + " --out " + out + "_again");
  ASSERT_EQ(first.status, 0) << first.output;
  EXPECT_EQ(value_in(first.output, "digest"), value_in(second.output, "digest"));
  const auto replay =
      run_vinerow(options + " --set 'rover.autopilot={type: replay, rate_Hz: 100, file: " + out +
                  "/products/rover.autopilot/x.pcap}' --out " + out + "_replay");
  EXPECT_EQ(value_in(replay.output, "digest"), value_in(first.output, "digest")) << replay.output;
}

TEST(RealArdupilot, FirmwareOfAnotherVehicleIsRefused) {
  if (!has_firmware()) GTEST_SKIP() << "VINEROW_ARDUPILOT names no folder with ardurover";
  const ScratchFolder folder("real_other");
  const auto run = run_vinerow("run " + kFleet + only("rover") +
                               " --set 'rover.autopilot.command=[arducopter]' --out " +
                               (folder.path() / "run").string());
  EXPECT_NE(run.status, 0);
  EXPECT_THAT(run.output, ::testing::HasSubstr("is firmware for a quadrotor, and this is a rover"));
}

}  // namespace
}  // namespace vinerow::real_ardupilot_test
