#include "engine/ros2/names.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"

namespace vinerow::ros2::names_test {
namespace {

TEST(Names, ResolvesRelativeNames) {
  EXPECT_EQ(resolve_name("/rover/imu", "/estate", "node"), "/rover/imu");
  EXPECT_EQ(resolve_name("imu", "/estate", "node"), "/estate/imu");
  EXPECT_EQ(resolve_name("rover/imu", "/", "node"), "/rover/imu");
  EXPECT_EQ(resolve_name("~/imu", "/estate", "node"), "/estate/node/imu");
  EXPECT_EQ(resolve_name("~/imu", "/", "node"), "/node/imu");
}

TEST(Names, RefusesInvalidTopics) {
  const std::string too_long = "/" + std::string(247, 'a');
  for (const std::string& name :
       {std::string(), std::string("/"), std::string("/a/"), std::string("/a//b"),
        std::string("/1a"), std::string("/a-b"), std::string("/a b"), std::string("~"),
        std::string("/\xc3\xa4"), too_long}) {
    EXPECT_THROW(resolve_name(name, "/", "node"), ConfigError) << name;
  }
}

TEST(Names, RefusesInvalidNodes) {
  EXPECT_NO_THROW(check_node_name("vinerow_1"));
  for (const char* name : {"", "1a", "a/b", "a-b"}) {
    EXPECT_THROW(check_node_name(name), ConfigError) << name;
  }
  EXPECT_NO_THROW(check_name_space("/"));
  EXPECT_NO_THROW(check_name_space("/estate/north"));
  for (const char* name : {"", "estate", "/estate/", "//"}) {
    EXPECT_THROW(check_name_space(name), ConfigError) << name;
  }
}

TEST(Names, MapsTypesToDds) {
  EXPECT_EQ(dds_type_name("sensor_msgs/msg/Imu"), "sensor_msgs::msg::dds_::Imu_");
  EXPECT_EQ(dds_type_name("std_srvs/srv/Trigger_Request"), "std_srvs::srv::dds_::Trigger_Request_");
  for (const char* type :
       {"", "Imu", "sensor_msgs/Imu", "sensor_msgs/foo/Imu", "a/msg/", "a/msg/B/C"}) {
    EXPECT_THROW(dds_type_name(type), ConfigError) << type;
  }
}

}  // namespace
}  // namespace vinerow::ros2::names_test
