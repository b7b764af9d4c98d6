/// Commands as ROS 2 messages.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/api/messages.h"
#include "engine/core/error.h"
#include "engine/live/command_codec.h"
#include "engine/record/cdr.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::live::command_codec_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <class T>
const T& value_of(const OutsideCommand& command) {
  return static_cast<const Signal<T>&>(*command.value).value();
}

std::vector<std::uint8_t> bytes_of(const record::ByteBuffer& buffer) {
  return {buffer.view().begin(), buffer.view().end()};
}

std::string error_of(const std::string& type, const std::string& ros_type,
                     std::span<const std::uint8_t> bytes) {
  try {
    decode_command("rover/x", type, ros_type, bytes);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(CommandCodec, ReadsATwist) {
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  for (const double value : {1.5, 0.0, 0.0, 0.0, 0.0, -0.25}) out.add(value);
  for (const char* type : {"geometry_msgs/msg/Twist", "geometry_msgs/Twist"}) {
    const OutsideCommand command =
        decode_command("rover/cmd_vel", "VelocityCommand", type, bytes_of(buffer));
    EXPECT_EQ(command.stamp.ns, 0);
    EXPECT_EQ(command.value->name(), "rover/cmd_vel");
    EXPECT_EQ(value_of<VelocityCommand>(command).v_mps, 1.5);
    EXPECT_EQ(value_of<VelocityCommand>(command).yaw_rate_radps, -0.25);
  }
}

TEST(CommandCodec, TakesTheStampOfTheHeader) {
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  record::write_header(out, Time{3'250'000'000}, "base_link");
  for (const double value : {1.0, 0.0, 0.0, 0.0, 0.0, 0.5}) out.add(value);
  const OutsideCommand command = decode_command("rover/cmd_vel", "VelocityCommand",
                                                "geometry_msgs/msg/TwistStamped", bytes_of(buffer));
  EXPECT_EQ(command.stamp.ns, 3'250'000'000);
  EXPECT_EQ(value_of<VelocityCommand>(command).yaw_rate_radps, 0.5);
}

TEST(CommandCodec, TakesOfAJointTheValueThatItsUnitAsksFor) {
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  record::write_header(out, Time{1}, "");
  const std::vector<std::string> names = {"axle_front_steer_rad", "wheel_fl_speed_radps"};
  out.add_count(names.size());
  for (const std::string& name : names) out.add(std::string_view(name));
  for (const std::vector<double>& list :
       {std::vector<double>{0.1, 0.2}, std::vector<double>{3.0, 4.0}, std::vector<double>{}}) {
    out.add_count(list.size());
    out.add_doubles(list.data(), list.size());
  }
  const OutsideCommand command = decode_command("rover/actuator_command", "NamedValues",
                                                "sensor_msgs/msg/JointState", bytes_of(buffer));
  EXPECT_EQ(value_of<NamedValues>(command).names, names);
  EXPECT_THAT(value_of<NamedValues>(command).values, ElementsAre(0.1, 4.0));
}

/// A pose as RViz sends it; the covariance is that of its "2D Pose Estimate".
std::vector<std::uint8_t> pose_message(const std::string& frame, double qw, bool with_covariance) {
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  record::write_header(out, Time{1'000'000'000}, frame);
  for (const double value : {3.0, -2.0, 0.0, 0.0, 0.0, 0.6, qw}) out.add(value);
  for (int i = 0; with_covariance && i < 36; ++i) {
    out.add(i == 0 || i == 7 ? 0.25 : i == 35 ? 0.0685 : 0.0);
  }
  return bytes_of(buffer);
}

TEST(CommandCodec, ReadsGoalsAndInitialPosesInTheWorld) {
  const OutsideCommand goal =
      decode_command("rover/goal_pose", "PoseTarget", "geometry_msgs/msg/PoseStamped",
                     pose_message("map", 0.8, false));
  EXPECT_EQ(value_of<PoseTarget>(goal).X_WB.p, Eigen::Vector3d(3, -2, 0));
  // tan(yaw / 2) = 0.6 / 0.8
  EXPECT_NEAR(yaw_from_quaternion(value_of<PoseTarget>(goal).X_WB.q), 2 * std::atan(0.75), 1e-12);
  EXPECT_EQ(goal.stamp.ns, 1'000'000'000);

  EXPECT_EQ(command_types("Odometry").front(), "geometry_msgs/msg/PoseWithCovarianceStamped");
  const OutsideCommand pose =
      decode_command("rover/initialpose", "Odometry", "geometry_msgs/msg/PoseWithCovarianceStamped",
                     pose_message("", 0.8, true));
  const Odometry& estimate = value_of<Odometry>(pose);
  EXPECT_EQ(estimate.position_variance_m2, Eigen::Vector3d(0.25, 0.25, 0.0));
  EXPECT_NEAR(estimate.yaw_std_rad, std::sqrt(0.0685), 1e-15);
}

TEST(CommandCodec, RefusesPosesElsewhereOrWithoutOrientation) {
  const auto error = [](const std::vector<std::uint8_t>& bytes) {
    return error_of("PoseTarget", "geometry_msgs/msg/PoseStamped", bytes);
  };
  EXPECT_EQ(error(pose_message("rover/base_link", 0.8, false)),
            "the pose is in frame 'rover/base_link', must be in 'map'");
  EXPECT_EQ(error(pose_message("map", 0.0, false)),
            "the orientation of the pose has length 0.6, must be 1");
  std::vector<std::uint8_t> cut = pose_message("map", 0.8, false);
  cut.resize(cut.size() - 8);
  EXPECT_EQ(error(cut), "the bytes for 'rover/x' hold no geometry_msgs/msg/PoseStamped");
}

TEST(CommandCodec, KnowsWhichTypesLockStepCanUse) {
  EXPECT_FALSE(has_header("geometry_msgs/msg/Twist"));
  for (const char* type : {"geometry_msgs/msg/TwistStamped", "sensor_msgs/msg/JointState"}) {
    EXPECT_TRUE(has_header(type)) << type;
    const std::string message = type[0] == 'g' ? "VelocityCommand" : "NamedValues";
    EXPECT_THAT(command_definition(message, type), ::testing::StartsWith("std_msgs/Header header"));
  }
}

TEST(CommandCodec, ReadsAnyBuiltInMessageAsTheLogHasIt) {
  for_each_message_type([]<class T>(T*) {
    using Mapping = record::RosMapping<T>;
    if (std::is_same_v<T, VelocityCommand> || std::is_same_v<T, Event>) return;
    record::ByteBuffer buffer;
    record::CdrWriter out(buffer);
    const record::FrameNames frames = record::FrameNames::of_signal("rover/x");
    const T value{};
    if constexpr (requires { &Mapping::write_exact; }) {
      Mapping::write_exact(out, {frames, Time{9}}, value);
    } else {
      Mapping::write(out, {frames, Time{9}}, value);
    }
    const std::vector<std::string> types = command_types(T::kType);
    ASSERT_FALSE(types.empty());
    const OutsideCommand command =
        decode_command("rover/x", T::kType, types.back(), bytes_of(buffer));
    EXPECT_STREQ(command.value->type(), T::kType);
    EXPECT_FALSE(command_definition(T::kType, types.back()).empty());
  });
  EXPECT_THAT(command_types("acme/Soil"), ElementsAre());
}

TEST(CommandCodec, NamesTheTypeThatItTakes) {
  const std::vector<std::uint8_t> none;
  EXPECT_EQ(error_of("VelocityCommand", "std_msgs/msg/String", none),
            "'rover/x' takes geometry_msgs/msg/Twist, geometry_msgs/msg/TwistStamped, not "
            "'std_msgs/msg/String'");
  const std::vector<std::uint8_t> little = {0, 1, 0, 0, 1, 2};
  EXPECT_EQ(error_of("VelocityCommand", "geometry_msgs/msg/Twist", little),
            "the bytes for 'rover/x' hold no geometry_msgs/msg/Twist");
  EXPECT_THAT(error_of("VelocityCommand", "geometry_msgs/msg/TwistStamped", little),
              HasSubstr("hold no geometry_msgs/msg/TwistStamped"));
  EXPECT_THAT(error_of("NamedValues", "vinerow_msgs/msg/NamedValues", little),
              HasSubstr("hold no vinerow_msgs/msg/NamedValues"));
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  record::write_header(out, Time{1}, "");
  out.add_count(1);
  out.add(std::string_view("wheel_fl_speed_radps"));
  for (int i = 0; i < 3; ++i) out.add_count(0);
  EXPECT_EQ(error_of("NamedValues", "sensor_msgs/msg/JointState", bytes_of(buffer)),
            "joint 'wheel_fl_speed_radps' has no value in velocity");
}

}  // namespace
}  // namespace vinerow::live::command_codec_test
