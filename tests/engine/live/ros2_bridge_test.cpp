/// A run as a ROS 2 node. A peer that is not ours (Fast DDS, tests/engine/ros2/fast_dds_peer.cpp)
/// drives a rover along a row in lock-step.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "engine/api/map.h"
#include "engine/live/ros2_bridge.h"
#include "engine/run/command_log.h"
#include "engine/sim/session.h"
#include "engine/sim/simulation.h"
#include "tests/engine/live/live_support.h"
#include "tests/engine/ros2/peer_process.h"
#include "tests/engine/ros2/test_messages.h"
#include "tests/scenarios/command.h"

namespace vinerow::live::ros2_bridge_test {
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
        return make_ros2_bridge(
            live, {.domain = ros2::test_domain(), .is_lockstep = true, .holds_start = true});
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
        return make_ros2_bridge(
            live, {.domain = ros2::test_domain(), .is_lockstep = true, .holds_start = true});
      });
  const run::RunResult result = run.join();
  EXPECT_EQ(result.status, run::RunStatus::kBrokenOff);
  EXPECT_THAT(result.error, HasSubstr("no peer for 'rover/cmd_vel' has appeared for 0.3 s"));
}

/// Serves a run as a ROS 2 node.
std::shared_ptr<void> serve(LiveRun& live) {
  return make_ros2_bridge(live, {.domain = ros2::test_domain()});
}

ros2::NodeOptions peer_options() {
  return ros2::test_options("peer");
}

TEST(Ros2Bridge, AnswersAServiceOfAStranger) {
  ros2::PeerProcess peer({FAST_DDS_PEER, std::to_string(ros2::test_domain()), "state"});
  test::BackgroundRun run(test::remote_rover(), {.speed = 0.0, .paused = true}, {}, serve);
  EXPECT_EQ(peer.wait_for("state "), "state 2 1") << "paused, result OK";
}

TEST(Ros2Bridge, PublishesTheClockAndWhatALateNodeNeeds) {
  ros2::Node node(peer_options());
  const auto clock =
      node.create_subscription("/clock", "rosgraph_msgs/msg/Clock", ros2::kClockQos, "");
  const auto imu =
      node.create_subscription("/rover/imu", "sensor_msgs/msg/Imu", ros2::kSensorDataQos, "");
  const auto fixed =
      node.create_subscription("/tf_static", "tf2_msgs/msg/TFMessage", ros2::kLatchedQos, "");
  const auto echo = node.create_subscription("/rover/cmd_vel", "geometry_msgs/msg/TwistStamped",
                                             ros2::kDefaultQos, "");
  test::BackgroundRun run(test::remote_rover(), {.speed = 0.0, .paused = true}, {}, serve);
  run.await([&] { return clock->publisher_count() == 1 && imu->publisher_count() == 1; });
  ros2::Message message;
  run.await([&] { return fixed->take(message); });
  // Best effort: samples may be lost before both ends have matched.
  std::int64_t ns = 0;
  run.await([&] {
    run.control().step(20, [](const std::string&) {});
    if (!clock->take(message)) return false;
    record::CdrReader in(message.cdr);
    ns = std::int64_t{in.read<std::int32_t>()} * 1'000'000'000 + in.read<std::uint32_t>();
    return ns > 0;
  });
  EXPECT_EQ(ns % 1'000'000, 0) << "an instant";
  run.await([&] {
    run.control().step(20, [](const std::string&) {});
    return imu->take(message);
  });
  EXPECT_EQ(echo->publisher_count(), 0) << "commands are not published again";
}

/// What a nav_msgs/msg/OccupancyGrid has of a point of its frame, by the definition of the message:
/// row after row, cells of a row along x, from the origin on.
struct RosGrid {
  explicit RosGrid(const std::vector<std::uint8_t>& cdr) {
    record::CdrReader in(cdr);
    for (int i = 0; i < 2; ++i) in.read<std::uint32_t>();
    frame = in.read_text();
    for (int i = 0; i < 2; ++i) in.read<std::uint32_t>();
    resolution = in.read<float>();
    width = in.read<std::uint32_t>();
    height = in.read<std::uint32_t>();
    in.read_doubles(origin, 7);
    data.resize(in.read_count(1));
    in.read_octets(data.data(), data.size());
    is_sound = in.ok() && data.size() == std::size_t{width} * height;
  }
  int at(double x_m, double y_m) const {
    const auto i = static_cast<std::size_t>((x_m - origin[0]) / resolution);
    const auto j = static_cast<std::size_t>((y_m - origin[1]) / resolution);
    return data.at(i + j * width);
  }

  std::string frame;
  double resolution = 0.0;
  double origin[7] = {};
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> data;
  bool is_sound = false;
};

TEST(Ros2Bridge, ALateNodeReceivesMapAndDescription) {
  const test::ScratchFolder out("ros2_description");
  test::BackgroundRun run(test::remote_rover(), {.speed = 0.0, .paused = true}, out.path(),
                          [&](LiveRun& live) -> std::shared_ptr<void> {
                            return make_ros2_bridge(
                                live, {.domain = ros2::test_domain(), .out = out.path()});
                          });
  run.await_state(RunState::kPaused);
  EXPECT_EQ(test::answer_of([&](Answer answer) { run.control().step(20, answer); }), "");

  ros2::Node node(peer_options());
  const auto text = node.create_subscription("/rover/robot_description", "std_msgs/msg/String",
                                             ros2::kLatchedQos, "");
  const auto map =
      node.create_subscription("/map", "nav_msgs/msg/OccupancyGrid", ros2::kLatchedQos, "");
  const auto logged =
      node.create_subscription("/run/map", "nav_msgs/msg/OccupancyGrid", ros2::kLatchedQos, "");
  ros2::Message message;
  run.await([&] { return text->take(message); });
  record::CdrReader in(message.cdr);
  const std::string urdf(in.read_text());
  EXPECT_TRUE(in.ok());
  EXPECT_LT(in.remaining(), 4u) << "DDS pads";
  EXPECT_EQ(urdf, test::read_text(out.path() / "robot_description" / "rover.urdf"));
  EXPECT_THAT(urdf, HasSubstr("<link name=\"base_link\"/>"));
  EXPECT_THAT(urdf, HasSubstr("robot_description/rover/wheel_fl.dae\""));

  run.await([&] { return map->take(message); });
  EXPECT_EQ(logged->publisher_count(), 0);
  const RosGrid grid(message.cdr);
  ASSERT_TRUE(grid.is_sound);
  EXPECT_EQ(grid.frame, "map");
  // Rows are occupied, the alley between them is free.
  const std::shared_ptr<const Registry> registry(std::shared_ptr<void>(), &test::all_parts());
  const Session session(test::remote_rover(), registry);
  const std::vector<PlantRow>& rows = session.simulation().world().rows->rows;
  ASSERT_EQ(rows.size(), 2u);
  const Eigen::Vector3d a = 0.5 * (rows[0].line_W.front() + rows[0].line_W.back());
  const Eigen::Vector3d b = 0.5 * (rows[1].line_W.front() + rows[1].line_W.back());
  EXPECT_EQ(grid.at(a.x(), a.y()), 100);
  EXPECT_EQ(grid.at(b.x(), b.y()), 100);
  EXPECT_EQ(grid.at(0.5 * (a + b).x(), 0.5 * (a + b).y()), 0);
}

TEST(Ros2Bridge, TransformsHaveAnOdometryFrame) {
  ros2::Node node(peer_options());
  const auto tf =
      node.create_subscription("/tf", "tf2_msgs/msg/TFMessage", ros2::kTransformsQos, "");
  const auto odom =
      node.create_subscription("/rover/odom", "nav_msgs/msg/Odometry", ros2::kSensorDataQos, "");
  std::string text = test::kRemoteRover;
  text.replace(text.find("sensors: {"), 10, "sensors: {odom: {type: wheel_odometry}, ");
  test::BackgroundRun run(scenario::parse_scenario(text, ".", test::all_parts()),
                          {.speed = 0.0, .paused = true}, {}, serve);
  run.await([&] { return tf->publisher_count() == 1 && odom->publisher_count() == 1; });
  std::map<std::string, std::string> parents;
  ros2::Message message;
  run.await([&] {
    run.control().step(20, [](const std::string&) {});
    while (tf->take(message)) {
      record::CdrReader in(message.cdr);
      for (auto count = in.read<std::uint32_t>(); count > 0; --count) {
        for (int i = 0; i < 2; ++i) in.read<std::uint32_t>();
        const std::string parent(in.read_text());
        parents[std::string(in.read_text())] = parent;
        double pose[7];
        in.read_doubles(pose, 7);
      }
      EXPECT_TRUE(in.ok());
    }
    return parents.contains("rover/wheel_fl");
  });
  EXPECT_EQ(parents.at("rover/odom"), "map");
  EXPECT_EQ(parents.at("rover/base_link"), "rover/odom");
  EXPECT_EQ(parents.at("rover/wheel_fl"), "rover/base_link");
  run.await([&] {
    run.control().step(20, [](const std::string&) {});
    return odom->take(message);
  });
  record::CdrReader in(message.cdr);
  for (int i = 0; i < 2; ++i) in.read<std::uint32_t>();
  EXPECT_EQ(in.read_text(), "rover/odom");
  EXPECT_EQ(in.read_text(), "rover/base_link");
}

TEST(Ros2Bridge, SaysOnceWhatIsWrongWithACommand) {
  ros2::Node node(peer_options());
  const auto commands =
      node.create_publisher("/rover/cmd_vel", "geometry_msgs/msg/Twist", ros2::kDefaultQos, "");
  test::BackgroundRun run(test::remote_rover(), {.speed = 0.0, .paused = true}, {}, serve);
  run.await_state(RunState::kPaused);
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  for (int i = 0; i < 6; ++i) out.add(std::numeric_limits<double>::quiet_NaN());
  const std::string nan = "the command for 'rover/cmd_vel' contains NaN\n";
  run.await([&] {
    commands->publish(buffer.view());
    return !run.said().empty();
  });
  for (int i = 0; i < 20; ++i) commands->publish(buffer.view());
  const std::vector<std::uint8_t> damaged = {0, 1, 0, 0, 1, 2, 3, 4};
  run.await([&] {
    commands->publish(damaged);
    return run.said() != nan;
  });
  EXPECT_EQ(run.said(), nan +
                            "topic '/rover/cmd_vel': the bytes for 'rover/cmd_vel' hold no "
                            "geometry_msgs/msg/Twist\n");
}

TEST(Ros2Bridge, SaysNothingOfCommandsAfterTheEnd) {
  ros2::Node node(peer_options());
  const auto commands =
      node.create_publisher("/rover/cmd_vel", "geometry_msgs/msg/Twist", ros2::kDefaultQos, "");
  test::BackgroundRun run(test::remote_rover(), {.speed = 0.0, .paused = true}, {}, serve);
  run.await([&] { return commands->subscriber_count() == 1; });
  run.control().resume();
  run.await_state(RunState::kOver);
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  for (int i = 0; i < 6; ++i) out.add(0.0);
  for (int i = 0; i < 20; ++i) {
    commands->publish(buffer.view());
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(run.said(), "");
}

}  // namespace
}  // namespace vinerow::live::ros2_bridge_test
