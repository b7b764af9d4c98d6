/// JSON and CDR of one message, against the encoder of the logs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/live/message_json.h"
#include "engine/record/ros_definitions.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::live::message_json_test {
namespace {

using nlohmann::json;

record::RosSchema schema_of(const std::string& type) {
  return record::RosSchema::parse(type, record::full_ros_definition(type));
}

template <class T>
std::vector<std::uint8_t> logged(const T& value, const std::string& signal, Time stamp) {
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  const record::FrameNames frames = record::FrameNames::of_signal(signal);
  record::RosMapping<T>::write(out, {frames, stamp}, value);
  return {buffer.view().begin(), buffer.view().end()};
}

std::string error_of(const std::string& type, const json& value) {
  try {
    cdr_from_json(value, schema_of(type));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(MessageJson, AgreesWithTheLogsEncoder) {
  const VelocityCommand command{1.25, -0.5};
  const std::vector<std::uint8_t> bytes = logged(command, "rover/cmd_vel", Time{2'000'000'003});
  const record::RosSchema schema = schema_of("geometry_msgs/msg/TwistStamped");
  const json expected = json::parse(R"({
    "header": {"stamp": {"sec": 2, "nanosec": 3}, "frame_id": "rover/base_link"},
    "twist": {"linear": {"x": 1.25, "y": 0, "z": 0}, "angular": {"x": 0, "y": 0, "z": -0.5}}})");
  EXPECT_EQ(json_from_cdr(bytes, schema), expected);
  EXPECT_EQ(cdr_from_json(expected, schema), bytes);
}

TEST(MessageJson, GoesThereAndBackForAMessageOfManyKinds) {
  Odometry odometry;
  odometry.X_WB.p = {1, 2, 3};
  odometry.yaw_std_rad = 0.25;
  const std::vector<std::uint8_t> bytes = logged(odometry, "rover/truth", Time{5});
  const record::RosSchema schema = schema_of("nav_msgs/msg/Odometry");
  EXPECT_EQ(cdr_from_json(json_from_cdr(bytes, schema), schema), bytes);
  PlannedPath path;
  path.points.resize(3);
  const std::vector<std::uint8_t> path_bytes = logged(path, "rover/plan", Time{7});
  const record::RosSchema path_schema = schema_of("nav_msgs/msg/Path");
  EXPECT_EQ(json_from_cdr(path_bytes, path_schema)["poses"].size(), 3);
  EXPECT_EQ(cdr_from_json(json_from_cdr(path_bytes, path_schema), path_schema), path_bytes);
}

TEST(MessageJson, AbsentFieldsAreZero) {
  const record::RosSchema schema = schema_of("geometry_msgs/msg/TwistStamped");
  const json sparse = {{"twist", {{"linear", {{"x", 2}}}}}};
  const json full = json_from_cdr(cdr_from_json(sparse, schema), schema);
  EXPECT_EQ(full["twist"]["linear"]["x"], 2.0);
  EXPECT_EQ(full["header"]["frame_id"], "");
  const json old = {{"header", {{"stamp", {{"secs", 4}, {"nsecs", 5}}}}}};
  const json stamp = json_from_cdr(cdr_from_json(old, schema), schema)["header"]["stamp"];
  EXPECT_EQ(stamp, (json{{"sec", 4}, {"nanosec", 5}}));
}

TEST(MessageJson, NamesTheFieldThatIsWrong) {
  const std::string twist = "geometry_msgs/msg/Twist";
  EXPECT_EQ(error_of(twist, {{"linear", {{"x", "fast"}}}}),
            "linear.x = \"fast\", must be a number");
  EXPECT_EQ(error_of(twist, {{"liner", 1}}),
            "geometry_msgs/Twist has no field 'liner'; did you mean 'linear'? (fields: linear, "
            "angular)");
  EXPECT_EQ(error_of(twist, 5), "the message = 5, must be an object");
  EXPECT_EQ(
      error_of("geometry_msgs/msg/TwistStamped", {{"header", {{"stamp", {{"nanosec", -1}}}}}}),
      "header.stamp.nanosec = -1, must be a whole number in the range of its type");
  EXPECT_EQ(error_of("nav_msgs/msg/Odometry", {{"pose", {{"covariance", {1, 2}}}}}),
            "pose.covariance = [1,2], must be a list of 36 values");
  EXPECT_EQ(error_of("sensor_msgs/msg/JointState", {{"name", {1}}}), "name[0] = 1, must be a text");
}

TEST(MessageJson, TakesNumbersUpToTheLimitsOfTheirType) {
  const auto there_and_back = [](const std::string& type, const json& value) {
    const auto schema = record::RosSchema::parse("test_msgs/msg/Number", type + " x\n");
    return json_from_cdr(cdr_from_json({{"x", value}}, schema), schema)["x"];
  };
  constexpr auto kLargest = std::numeric_limits<std::uint64_t>::max();
  constexpr auto kLargestSigned = std::numeric_limits<std::int64_t>::max();
  constexpr double kLargestSingle = std::numeric_limits<float>::max();
  EXPECT_EQ(there_and_back("uint64", kLargest), kLargest);
  EXPECT_EQ(there_and_back("int64", kLargestSigned), kLargestSigned);
  EXPECT_EQ(there_and_back("int64", -kLargestSigned - 1), -kLargestSigned - 1);
  EXPECT_EQ(there_and_back("int8", -128.0), -128);
  EXPECT_EQ(there_and_back("float32", -kLargestSingle), -kLargestSingle);
  EXPECT_THROW(there_and_back("int64", kLargest), ConfigError);
  EXPECT_THROW(there_and_back("uint64", 18446744073709551616.0), ConfigError);
  EXPECT_THROW(there_and_back("int8", 128), ConfigError);
  EXPECT_THROW(there_and_back("float32", 1e39), ConfigError) << "it would become infinite";
}

TEST(MessageJson, RefusesBytesThatAreNoSuchMessage) {
  const std::vector<std::uint8_t> bytes = {0, 1, 0, 0, 1, 2, 3};
  EXPECT_THROW(json_from_cdr(bytes, schema_of("geometry_msgs/msg/Twist")), ConfigError);
  EXPECT_THROW(json_from_cdr({}, schema_of("nav_msgs/msg/Path")), ConfigError);
}

TEST(MessageJson, NumbersThatAreNotFiniteBecomeNull) {
  record::ByteBuffer buffer;
  record::CdrWriter out(buffer);
  for (int i = 0; i < 6; ++i) out.add(std::numeric_limits<double>::infinity());
  EXPECT_TRUE(
      json_from_cdr(buffer.view(), schema_of("geometry_msgs/msg/Twist"))["linear"]["x"].is_null());
}

TEST(MessageJson, LimitsTheDepthOfATextThatItParses) {
  const auto nested = [](std::size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
  };
  EXPECT_EQ(parse_json(nested(64)), json::parse(nested(64)));
  EXPECT_THROW(parse_json(nested(65)), ConfigError);
  EXPECT_TRUE(parse_json("[1,").is_discarded());
}

}  // namespace
}  // namespace vinerow::live::message_json_test
