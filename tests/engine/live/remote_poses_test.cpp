/// Goals and poses that a viewer gives a run, with their replay.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/live/message_hub.h"
#include "engine/run/command_log.h"
#include "engine/sim/simulation.h"
#include "tests/engine/live/live_support.h"
#include "tests/scenarios/command.h"

namespace vinerow::live::remote_poses_test {
namespace {

using test::BackgroundRun;
using ::testing::HasSubstr;

/// The rover drives to goals, on an estimate that can be replaced.
scenario::Scenario goal_rover() {
  std::string text = test::kRemoteRover;
  const std::string remote = "controller: {type: remote_velocity, timeout_s: 0.3}";
  text.replace(text.find(remote), remote.size(),
               "guidance: {type: remote_goal}\n"
               "    controller: {type: path_follower}\n"
               "    estimator: {type: error_state_kalman, initial_pose_from_outside: true}");
  text.replace(text.find("sensors: {"), 10, "sensors: {gps: {type: gnss, rate_Hz: 5}, ");
  text.replace(text.find("duration_s: 2"), 13, "duration_s: 8");
  return scenario::parse_scenario(text, ".", test::all_parts());
}

std::string pose_json(double x_m, double y_m) {
  return fmt::format(R"("position": {{"x": {}, "y": {}}}, "orientation": {{"z": 0.6, "w": 0.8}})",
                     x_m, y_m);
}

std::string publish(LiveRun& live, const std::string& topic, const std::string& type,
                    const std::string& json) {
  return live.publish(topic, type, "json",
                      {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()}, "viewer");
}

TEST(RemotePoses, AreInTheRecordAndAReplayRepeatsThem) {
  const test::ScratchFolder folder("live_poses");
  Eigen::Vector2d goal = {0, 0}, moved = {0, 0};
  bool had_channels = true;
  const auto watch = [&](LiveRun& live) {
    live.on_built([&](const Simulation& simulation) {
      const auto& line = simulation.world().rows->alleys.front().line_W;
      goal = (0.4 * line.front() + 0.6 * line.back()).head<2>();
      moved = (0.9 * line.front() + 0.1 * line.back()).head<2>();
      had_channels = live.hub() != nullptr;
    });
    return nullptr;
  };
  std::string digest;
  {
    BackgroundRun run(goal_rover(), {.speed = 0.0, .paused = true}, folder.path(), watch);
    run.await_state(RunState::kPaused);
    EXPECT_FALSE(had_channels) << "a client that sees the channels may command at once";
    EXPECT_EQ(test::answer_of([&](Answer answer) { run.control().step(1000, std::move(answer)); }),
              "");
    const std::string initial =
        fmt::format(R"({{"header": {{"frame_id": "map"}}, "pose": {{"pose": {{{}}}}}}})",
                    pose_json(moved.x(), moved.y()));
    EXPECT_EQ(publish(*run.live, "/rover/initialpose",
                      "geometry_msgs/msg/PoseWithCovarianceStamped", initial),
              "");
    const std::string target = fmt::format(R"({{"pose": {{{}}}}})", pose_json(goal.x(), goal.y()));
    EXPECT_EQ(publish(*run.live, "/rover/goal_pose", "geometry_msgs/PoseStamped", target), "");
    run.control().resume();
    digest = run.join().digest;
  }
  EXPECT_NE(digest, test::run_alone(goal_rover()).digest);
  const run::CommandLog log = run::read_command_log(folder.path() / "log.mcap");
  EXPECT_EQ(log.commands.size(), 2u);
  const auto replay = std::make_shared<run::CommandReplay>(log);
  EXPECT_EQ(test::run_alone(goal_rover(), replay).digest, digest);
}

TEST(RemotePoses, OfAnotherFrameAreRefused) {
  BackgroundRun run(goal_rover(), {.speed = 0.0, .paused = true});
  run.await_state(RunState::kPaused);
  const std::string target =
      fmt::format(R"({{"header": {{"frame_id": "odom"}}, "pose": {{{}}}}})", pose_json(1, 2));
  EXPECT_EQ(publish(*run.live, "/rover/goal_pose", "geometry_msgs/msg/PoseStamped", target),
            "topic '/rover/goal_pose': the pose is in frame 'odom', must be in 'map'");
  EXPECT_THAT(publish(*run.live, "/rover/goal_pose", "geometry_msgs/msg/PoseStamped", "{}"),
              HasSubstr("the orientation of the pose has length 0, must be 1"));
}

}  // namespace
}  // namespace vinerow::live::remote_poses_test
