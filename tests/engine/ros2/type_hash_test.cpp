/// Type hashes of ROS 2 that other projects published, computed by rosidl or seen on the wire.

#include "engine/ros2/type_hash.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "engine/record/ros_definitions.h"
#include "engine/ros2/discovery_info.h"

namespace vinerow::ros2::type_hash_test {
namespace {

std::string hash_of(std::string_view type) {
  return message_type_hash(type, record::full_ros_definition(type));
}

// Source: https://github.com/youtalk/swift-ros2 (commit 2d68d36), folder
// Sources/SwiftROS2Messages/Generated: `typeHash` of each type, for Jazzy, Kilted and Rolling.
TEST(TypeHash, MatchesHashesOfSwiftRos2) {
  EXPECT_EQ(hash_of("sensor_msgs/msg/Imu"),
            "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b");
  EXPECT_EQ(hash_of("std_msgs/msg/Header"),
            "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01");
  EXPECT_EQ(hash_of("geometry_msgs/msg/Twist"),
            "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a");
  EXPECT_EQ(hash_of("geometry_msgs/msg/TwistStamped"),
            "RIHS01_5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64");
  EXPECT_EQ(hash_of("geometry_msgs/msg/Vector3Stamped"),
            "RIHS01_d4829622288cbb443886e7ea94ea5671a3b1be6bab4ad04224432a65f7d7887a");
  EXPECT_EQ(hash_of("geometry_msgs/msg/PoseStamped"),
            "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8");
  EXPECT_EQ(hash_of("tf2_msgs/msg/TFMessage"),
            "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087");
  EXPECT_EQ(hash_of("sensor_msgs/msg/NavSatFix"),
            "RIHS01_62223ab3fe210a15976021da7afddc9e200dc9ec75231c1b6a557fc598a65404");
  EXPECT_EQ(hash_of("sensor_msgs/msg/LaserScan"),
            "RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828");
  EXPECT_EQ(hash_of("sensor_msgs/msg/FluidPressure"),
            "RIHS01_22dfb2b145a0bd5a31a1ac3882a1b32148b51d9b2f3bab250290d66f3595bc32");
  EXPECT_EQ(hash_of("sensor_msgs/msg/MagneticField"),
            "RIHS01_e80f32f56a20486c9923008fc1a1db07bbb273cbbf6a5b3bfa00835ee00e4dff");
  EXPECT_EQ(hash_of("sensor_msgs/msg/BatteryState"),
            "RIHS01_4bee5dfce981c98faa6828b868307a0a73f992ed0789f374ee96c8f840e69741");
  EXPECT_EQ(hash_of("sensor_msgs/msg/CompressedImage"),
            "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a");
}

// Source: https://github.com/ZettaScaleLabs/ros-z (commit 9bb6305),
// crates/ros-z-codegen/tests/hash_regression.rs, checked there against rmw_zenoh_cpp.
TEST(TypeHash, MatchesHashesOfRosZ) {
  EXPECT_EQ(message_type_hash("std_msgs/msg/String", "string data\n"),
            "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18");
  EXPECT_EQ(hash_of("nav_msgs/msg/Odometry"),
            "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0");
}

// Sources: zenoh-plugin-ros2dds (ParticipantEntitiesInfo, Iron and Jazzy); liveliness tokens of
// rmw_zenoh_cpp (Log); CARLA's ROS 2 publishers (Clock, captured with `ros2 topic info -v`).
TEST(TypeHash, MatchesHashesSeenOnTheWire) {
  // rcl, test_type_hash.cpp.
  EXPECT_EQ(hash_of("sensor_msgs/msg/PointCloud2"),
            "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5");
  EXPECT_EQ(message_type_hash(kDiscoveryType, discovery_definition()),
            "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e");
  EXPECT_EQ(hash_of("rcl_interfaces/msg/Log"),
            "RIHS01_e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac");
  EXPECT_EQ(message_type_hash("rosgraph_msgs/msg/Clock",
                              "builtin_interfaces/Time clock\n"
                              "===\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"),
            "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564");
}

// sensor_msgs/Range has the field `variance` since Iron, so the Humble form must differ. Source:
// swift-ros2, Generated/SensorMsgs/Range.swift.
TEST(TypeHash, DependsOnEveryField) {
  constexpr std::string_view kHumble =
      "std_msgs/Header header\nuint8 ULTRASOUND=0\nuint8 INFRARED=1\nuint8 radiation_type\n"
      "float32 field_of_view\nfloat32 min_range\nfloat32 max_range\nfloat32 range\n";
  constexpr std::string_view kHeader =
      "===\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
      "===\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
  const std::string jazzy = std::string(kHumble) + "float32 variance\n" + std::string(kHeader);
  const std::string humble = std::string(kHumble) + std::string(kHeader);
  constexpr const char* kJazzyHash =
      "RIHS01_b42b62562e93cbfe9d42b82fe5994dfa3d63d7d5c90a317981703f7388adff3a";
  EXPECT_EQ(message_type_hash("sensor_msgs/msg/Range", jazzy), kJazzyHash);
  EXPECT_NE(message_type_hash("sensor_msgs/msg/Range", humble), kJazzyHash);
}

// Bounded sequences and text, `byte`, empty messages. Sources: swift-ros2 (SetBool, Trigger, Empty,
// AddTwoInts: requests and responses; DescribeParameters, GetParameters), ros-z and ros2-client-rs
// tables (whole services).
TEST(TypeHash, MatchesHashesOfServices) {
  const ServiceTypeHashes add = service_type_hashes("example_interfaces/srv/AddTwoInts",
                                                    "int64 a\nint64 b\n---\nint64 sum\n");
  EXPECT_EQ(add.service, "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a");
  EXPECT_EQ(add.request, "RIHS01_000c5fd92d6b2e1a05949348f584d6d652adea1e92d691792011ac2273508302");
  EXPECT_EQ(add.response,
            "RIHS01_de5c030d4af33cba2749310b249737b631594703f9300495f48bffb2b44dcc2f");

  const ServiceTypeHashes trigger =
      service_type_hashes("std_srvs/srv/Trigger", "---\nbool success\nstring message\n");
  EXPECT_EQ(trigger.request,
            "RIHS01_d010825374ce8918e72bfd826c82603e60f45419e932ea976f807b74a863a199");
  EXPECT_EQ(trigger.response,
            "RIHS01_2d946c21e2fc3f1e9ca6986a8191d85fcc70097a8bb7771a053564bc47009cdf");

  const ServiceTypeHashes set_bool = service_type_hashes(
      "std_srvs/srv/SetBool", "bool data # comment\n---\nbool success\nstring message\n");
  EXPECT_EQ(set_bool.request,
            "RIHS01_c62fbb99d94e1b25e8ef9e109f9581956bb1b3361a45a4e5810c36a90d29932e");
  EXPECT_EQ(set_bool.response,
            "RIHS01_d0814e7f7b4880ab77e9c57426c7aa1562ab69f11eef8e2e968812f9cbd0b059");

  const ServiceTypeHashes get = service_type_hashes(
      "rcl_interfaces/srv/GetParameters",
      "string[] names\n---\nParameterValue[] values\n===\nMSG: rcl_interfaces/ParameterValue\n"
      "uint8 type\nbool bool_value\nint64 integer_value\nfloat64 double_value\n"
      "string string_value\nbyte[] byte_array_value\nbool[] bool_array_value\n"
      "int64[] integer_array_value\nfloat64[] double_array_value\nstring[] string_array_value\n");
  EXPECT_EQ(get.service, "RIHS01_bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc");
  EXPECT_EQ(get.response,
            "RIHS01_9fa773b46e39cc5d02db6224d8fd520bb9caeeffc2b27c96c1e59431baba9f2a");

  const ServiceTypeHashes describe = service_type_hashes(
      "rcl_interfaces/srv/DescribeParameters",
      "string[] names\n---\nParameterDescriptor[] descriptors\n"
      "===\nMSG: rcl_interfaces/ParameterDescriptor\nstring name\nuint8 type\nstring description\n"
      "string additional_constraints\nbool read_only false\nbool dynamic_typing false\n"
      "FloatingPointRange[<=1] floating_point_range\nIntegerRange[<=1] integer_range\n"
      "===\nMSG: rcl_interfaces/FloatingPointRange\n"
      "float64 from_value\nfloat64 to_value\nfloat64 step\n"
      "===\nMSG: rcl_interfaces/IntegerRange\nint64 from_value\nint64 to_value\nuint64 step\n");
  EXPECT_EQ(describe.service,
            "RIHS01_845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff");
}

std::string error_of(std::string_view name, std::string_view text) {
  try {
    message_type_hash(name, text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(TypeHash, RefusesBrokenDefinitions) {
  EXPECT_EQ(error_of("a/msg/B", "float64\n"),
            "the definition of a/msg/B has the line 'float64', must be a type and a name");
  EXPECT_EQ(error_of("a/msg/B", "C c\n"),
            "the definition of a/msg/B names the type 'a/msg/C', which it does not hold");
  EXPECT_EQ(error_of("a/msg/B", "int8[x] c\n"), "the definition of a/msg/B has the type 'int8[x]'");
  EXPECT_EQ(error_of("B", "int8 c\n"),
            "message type 'B', must be package/msg/Type or package/srv/Type");
  EXPECT_THROW(service_type_hashes("a/srv/B", "int8 a\n"), ConfigError);
}

// A type that holds itself has no CDR form, but the hash must end all the same.
TEST(TypeHash, EndsForTypesThatHoldThemselves) {
  EXPECT_EQ(message_type_hash("a/msg/B", "B[] b\n").size(), 71u);
}

}  // namespace
}  // namespace vinerow::ros2::type_hash_test
