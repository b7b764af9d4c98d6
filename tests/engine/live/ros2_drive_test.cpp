/// A ROS 2 peer that is not ours (Fast DDS, tests/engine/ros2/fast_dds_peer.cpp) drives a rover
/// along a row in lock-step.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/live/ros2_bridge.h"
#include "engine/run/command_log.h"
#include "tests/engine/live/live_support.h"
#include "tests/engine/ros2/peer_process.h"
#include "tests/engine/ros2/test_messages.h"
#include "tests/scenarios/command.h"

namespace vinerow::live::ros2_drive_test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kFiftySeconds =
    "lockstep: {topic: rover/cmd_vel, rate_Hz: 20, timeout_s: 20}\n";

scenario::Scenario fifty_seconds() {
  std::string text = std::string(test::kRemoteRover) + kFiftySeconds;
  text.replace(text.find("duration_s: 2"), 13, "duration_s: 50");
  return scenario::parse_scenario(text, ".", test::all_parts());
}

/// The run that the peer drives. @param delay_us  that the peer takes for each command
run::RunResult drive(const std::filesystem::path& out, int delay_us) {
  ros2::PeerProcess peer(
      {FAST_DDS_PEER, std::to_string(ros2::test_domain()), "drive", std::to_string(delay_us)});
  test::BackgroundRun run(
      fifty_seconds(), {.speed = 0.0}, out, [](LiveRun& live) -> std::shared_ptr<void> {
        return make_ros2_bridge(live, {.domain = ros2::test_domain(), .holds_start = true});
      });
  const run::RunResult result = run.join();
  EXPECT_EQ(peer.wait_for("drove 1000"), "drove 1000");
  EXPECT_EQ(run.said(), "");
  return result;
}

TEST(Ros2Drive, AStrangerDrivesARowInLockstep) {
  const test::ScratchFolder quick_folder("ros2_quick"), slow_folder("ros2_slow");
  const run::RunResult quick = drive(quick_folder.path(), 0);
  ASSERT_EQ(quick.error, "");
  const run::CommandLog log = run::read_command_log(quick_folder.path() / "log.mcap");
  EXPECT_EQ(log.commands.size(), 1000);
  std::printf("lock-step with Fast DDS: 50 s, 1000 commands in %.2f s\n", quick.wall_s);
  // The rover has followed its row.
  EXPECT_GT(quick.metrics.at("rover").at("distance_m"), 13.0);

  const run::RunResult slow = drive(slow_folder.path(), 10'000);
  EXPECT_EQ(slow.digest, quick.digest);
  EXPECT_GT(slow.wall_s, 10.0);

  const auto replay = std::make_shared<run::CommandReplay>(log);
  EXPECT_EQ(test::run_alone(fifty_seconds(), replay).digest, quick.digest);
}

TEST(Ros2Drive, WithoutAPeerTheRunEndsAtItsStart) {
  const std::string lockstep = "lockstep: {topic: rover/cmd_vel, rate_Hz: 20, timeout_s: 0.3}\n";
  test::BackgroundRun run(
      test::remote_rover(lockstep), {.speed = 0.0}, {}, [](LiveRun& live) -> std::shared_ptr<void> {
        return make_ros2_bridge(live, {.domain = ros2::test_domain(), .holds_start = true});
      });
  const run::RunResult result = run.join();
  EXPECT_EQ(result.status, run::RunStatus::kBrokenOff);
  EXPECT_THAT(result.error, HasSubstr("no peer for 'rover/cmd_vel' has appeared for 0.3 s"));
}

}  // namespace
}  // namespace vinerow::live::ros2_drive_test
