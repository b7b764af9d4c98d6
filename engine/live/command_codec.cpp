#include "engine/live/command_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/api/messages.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::live {
namespace {

constexpr const char* kTwist = "geometry_msgs/msg/Twist";
constexpr const char* kTwistStamped = "geometry_msgs/msg/TwistStamped";
constexpr const char* kJointState = "sensor_msgs/msg/JointState";
constexpr const char* kPoseWithCovariance = "geometry_msgs/msg/PoseWithCovarianceStamped";

/// "geometry_msgs/Twist" as "geometry_msgs/msg/Twist".
std::string full_type(std::string type) {
  const std::size_t slash = type.find('/');
  if (slash != std::string::npos && type.find('/', slash + 1) == std::string::npos) {
    type.insert(slash, "/msg");
  }
  return type;
}

struct Header {
  Time stamp;
  std::string frame;
};

/// Of a message that begins with a std_msgs/Header.
Header read_header(std::span<const std::uint8_t> cdr) {
  record::CdrReader in(cdr);
  const auto sec = in.read<std::int32_t>();
  const auto nanosec = in.read<std::uint32_t>();
  return {Time{std::int64_t{sec} * record::kNsPerS + nanosec}, std::string(in.read_text())};
}

/// Poses are in the world. A viewer whose fixed frame is another one would send them in that frame.
void check_world_frame(const std::string& frame) {
  const std::string& world = record::FrameNames().world;
  if (frame.empty() || frame == world) return;
  throw ConfigError(fmt::format("the pose is in frame '{}', must be in '{}'", frame, world));
}

/// Programs that leave the orientation unset send zeros.
void normalise(Eigen::Quaterniond& q) {
  constexpr double kTolerance = 1e-3;
  if (!(std::abs(q.norm() - 1.0) < kTolerance)) {
    throw ConfigError(
        fmt::format("the orientation of the pose has length {:g}, must be 1", q.norm()));
  }
  q.normalize();
}

/// geometry_msgs/PoseWithCovarianceStamped: the fields of Odometry without the velocities.
Odometry read_pose_with_covariance(record::CdrReader& in) {
  record::skip_header(in);
  Odometry pose;
  record::read_pose(in, pose.X_WB);
  const double yaw_variance =
      record::read_pose_covariance(in, pose.position_variance_m2, pose.position_covariance_m2);
  pose.yaw_std_rad = std::sqrt(std::max(yaw_variance, 0.0));
  return pose;
}

VelocityCommand read_twist(record::CdrReader& in) {
  VelocityCommand command;
  command.v_mps = in.read<double>();
  in.skip_doubles(4);
  command.yaw_rate_radps = in.read<double>();
  return command;
}

/// sensor_msgs/JointState: of each joint the value that the actuator's unit asks for.
NamedValues read_joints(record::CdrReader& in) {
  record::skip_header(in);
  NamedValues command;
  command.names.resize(in.read_count(sizeof(std::uint32_t)));
  for (std::string& name : command.names) in.read(name);
  std::vector<double> lists[3];  // position, velocity, effort
  for (std::vector<double>& list : lists) {
    list.resize(in.read_count(sizeof(double)));
    in.read_doubles(list.data(), list.size());
  }
  for (std::size_t i = 0; i < command.names.size(); ++i) {
    const std::string& name = command.names[i];
    const bool is_rate = name.ends_with("_radps") || name.ends_with("_mps");
    const bool is_effort = name.ends_with("_N") || name.ends_with("_Nm");
    const std::vector<double>& list = lists[is_rate ? 1 : is_effort ? 2 : 0];
    if (i >= list.size()) {
      throw ConfigError(fmt::format("joint '{}' has no value in {}", name,
                                    is_rate     ? "velocity"
                                    : is_effort ? "effort"
                                                : "position"));
    }
    command.values.push_back(list[i]);
  }
  return command;
}

}  // namespace

std::vector<std::string> command_types(const std::string& message_type) {
  if (message_type == VelocityCommand::kType) return {kTwist, kTwistStamped};
  if (message_type == Odometry::kType) {
    return {kPoseWithCovariance, record::RosMapping<Odometry>::type()};
  }
  std::vector<std::string> types;
  for_each_message_type([&]<class T>(T*) {
    using Mapping = record::RosMapping<T>;
    if (message_type != T::kType) return;
    types.push_back(Mapping::exact_type().empty() ? Mapping::type() : Mapping::exact_type());
  });
  if (message_type == NamedValues::kType) types.insert(types.begin(), kJointState);
  return types;
}

std::string check_command_type(const std::string& signal, const std::string& message_type,
                               const std::string& given_type) {
  const std::string ros_type = full_type(given_type);
  const std::vector<std::string> types = command_types(message_type);
  if (std::ranges::find(types, ros_type) != types.end()) return ros_type;
  throw ConfigError(fmt::format("'{}' takes {}, not '{}'", signal, join(types), given_type));
}

bool has_header(const std::string& ros_type) {
  return ros_type != kTwist;
}

std::string command_definition(const std::string& message_type, const std::string& ros_type) {
  for (const char* by_hand : {kTwist, kTwistStamped, kJointState, kPoseWithCovariance}) {
    if (ros_type == by_hand) return record::full_ros_definition(ros_type);
  }
  std::string text;
  for_each_message_type([&]<class T>(T*) {
    using Mapping = record::RosMapping<T>;
    if (message_type != T::kType) return;
    if constexpr (requires { &Mapping::write_exact; }) {
      text = Mapping::exact_definition();
    } else {
      text = Mapping::definition();
    }
  });
  return text;
}

OutsideCommand decode_command(const std::string& signal, const std::string& message_type,
                              const std::string& given_type, std::span<const std::uint8_t> cdr) {
  const std::string ros_type = check_command_type(signal, message_type, given_type);
  record::CdrReader in(cdr);
  const auto checked = [&](OutsideCommand command) {
    if (!in.ok()) throw ConfigError(fmt::format("the bytes for '{}' hold no {}", signal, ros_type));
    return command;
  };
  if (ros_type == kTwist) return checked(outside_command(signal, Time{}, read_twist(in)));
  const Header header = read_header(cdr);
  if (ros_type == kJointState) {
    return checked(outside_command(signal, header.stamp, read_joints(in)));
  }
  std::optional<OutsideCommand> command;
  const auto take = [&]<class T>(T value) {
    // Before the orientation: zeros of a message that ends early are no orientation either.
    if (!in.ok()) throw ConfigError(fmt::format("the bytes for '{}' hold no {}", signal, ros_type));
    if constexpr (requires { value.X_WB.q; }) {
      check_world_frame(header.frame);
      if (!has_nan_field(value)) normalise(value.X_WB.q);
    }
    command = outside_command(signal, header.stamp, value);
  };
  if (ros_type == kPoseWithCovariance && message_type == Odometry::kType) {
    take(read_pose_with_covariance(in));
    return *std::move(command);
  }
  for_each_message_type([&]<class T>(T*) {
    if (message_type != T::kType) return;
    T value;
    static_cast<void>(
        record::RosMapping<T>::read(in, record::FrameNames::of_signal(signal), value));
    take(std::move(value));
  });
  return *std::move(command);
}

}  // namespace vinerow::live
