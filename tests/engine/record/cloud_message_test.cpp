/// Bytes of clouds against the definition of sensor_msgs/PointCloud2 and the fields of drivers.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record::cloud_message_test {
namespace {

/// sensor_msgs/PointCloud2 after its header, read field by field.
struct Message {
  struct Field {
    std::uint32_t offset;
    int type;
  };
  std::uint32_t height, width, point_step, row_step;
  std::map<std::string, Field> fields;
  std::vector<std::uint8_t> data;
  bool is_dense;

  template <class T>
  T get(const char* name, std::size_t i) const {
    T value;
    std::memcpy(&value, data.data() + i * point_step + fields.at(name).offset, sizeof value);
    return value;
  }
};

std::vector<std::uint8_t> write(const PointCloud& cloud) {
  const FrameNames frames = FrameNames::of_signal("rover/lidar");
  ByteBuffer buffer;
  CdrWriter out(buffer);
  RosMapping<PointCloud>::write(out, {frames, Time{1'000'000'000}, nullptr}, cloud);
  return {buffer.data(), buffer.data() + buffer.size()};
}

Message decode(const std::vector<std::uint8_t>& bytes) {
  CdrReader in(bytes);
  skip_header(in);
  Message m{};
  m.height = in.read<std::uint32_t>();
  m.width = in.read<std::uint32_t>();
  for (auto left = in.read<std::uint32_t>(); left > 0; --left) {
    const std::string name(in.read_text());
    const auto offset = in.read<std::uint32_t>();
    const int type = in.read<std::uint8_t>();
    EXPECT_EQ(in.read<std::uint32_t>(), 1u) << name;
    m.fields[name] = {offset, type};
  }
  EXPECT_FALSE(in.read_bool());
  m.point_step = in.read<std::uint32_t>();
  m.row_step = in.read<std::uint32_t>();
  m.data.resize(in.read_count(1));
  in.read_octets(m.data.data(), m.data.size());
  m.is_dense = in.read_bool();
  EXPECT_TRUE(in.ok());
  EXPECT_EQ(in.remaining(), 0u);
  return m;
}

/// Two rows of two points; the third was not seen.
PointCloud four_points() {
  PointCloud cloud;
  cloud.rows = 2;
  cloud.x = {3.0F, 0.0F, 0.0F, 30.0F};
  cloud.y = {4.0F, -2.0F, 0.0F, 40.0F};
  cloud.z = {12.0F, 0.0F, 0.0F, 0.0F};
  cloud.intensity = {41.6F, 300.0F, 0.0F, 7.25F};
  cloud.time_s = {0.0F, 0.05F, 0.025F, 0.0999F};
  cloud.ring = {0, 0, 1, 1};
  cloud.return_number = {1, 1, 0, 1};
  return cloud;
}

// Constants of sensor_msgs/msg/PointField.
constexpr int kUint8 = 2, kUint16 = 4, kUint32 = 6, kFloat32 = 7;

void expect_types(const Message& message, const std::map<std::string, int>& types) {
  for (const auto& [name, type] : types) {
    ASSERT_TRUE(message.fields.contains(name)) << name;
    EXPECT_EQ(message.fields.at(name).type, type) << name;
  }
  EXPECT_EQ(message.fields.size(), types.size());
}

TEST(CloudMessage, AListHasTheFieldsOfVelodynesDriver) {
  PointCloud cloud = four_points();
  cloud.rows = 0;
  cloud.return_number = {1, 1, 2, 1};
  const Message message = decode(write(cloud));
  EXPECT_EQ(message.height, 1u);
  EXPECT_EQ(message.width, 4u);
  EXPECT_EQ(message.row_step, 4u * message.point_step);
  EXPECT_TRUE(message.is_dense);
  // velodyne_pointcloud: ring is uint16, time float32 in s.
  expect_types(message, {{"x", kFloat32},
                         {"y", kFloat32},
                         {"z", kFloat32},
                         {"intensity", kFloat32},
                         {"time", kFloat32},
                         {"ring", kUint16},
                         {"return_number", kUint8}});
  EXPECT_EQ(message.get<float>("time", 3), 0.0999F);
  EXPECT_EQ(message.get<std::uint8_t>("return_number", 2), 2);
}

TEST(CloudMessage, AnOrganisedOneHasTheFieldsOfOustersDriver) {
  const Message message = decode(write(four_points()));
  EXPECT_EQ(message.height, 2u);
  EXPECT_EQ(message.width, 2u);
  EXPECT_EQ(message.row_step, 2u * message.point_step);
  EXPECT_EQ(message.data.size(), 4u * message.point_step);
  EXPECT_FALSE(message.is_dense);
  // ouster_ros::Point: t in ns, range in mm, ring and reflectivity uint16.
  expect_types(message, {{"x", kFloat32},
                         {"y", kFloat32},
                         {"z", kFloat32},
                         {"intensity", kFloat32},
                         {"t", kUint32},
                         {"reflectivity", kUint16},
                         {"ring", kUint16},
                         {"range", kUint32},
                         {"time", kFloat32},
                         {"return_number", kUint8}});
  // 3, 4, 12 m are 13 m.
  EXPECT_EQ(message.get<std::uint32_t>("range", 0), 13'000u);
  EXPECT_EQ(message.get<std::uint32_t>("range", 1), 2'000u);
  EXPECT_EQ(message.get<std::uint32_t>("range", 2), 0u);
  EXPECT_EQ(message.get<std::uint32_t>("range", 3), 50'000u);
  EXPECT_EQ(message.get<std::uint16_t>("reflectivity", 0), 42);
  EXPECT_EQ(message.get<std::uint16_t>("reflectivity", 1), 255);
  EXPECT_EQ(message.get<std::uint16_t>("reflectivity", 3), 7);
  // Single precision: 0.05 s to 2 ns, 0.0999 s to 4 ns.
  EXPECT_NEAR(message.get<std::uint32_t>("t", 1), 50'000'000.0, 2.0);
  EXPECT_NEAR(message.get<std::uint32_t>("t", 3), 99'900'000.0, 4.0);
  EXPECT_TRUE(std::isnan(message.get<float>("x", 2)));
  EXPECT_TRUE(std::isnan(message.get<float>("z", 2)));
  EXPECT_EQ(message.get<std::uint16_t>("ring", 2), 1);
  EXPECT_NEAR(message.get<std::uint32_t>("t", 2), 25'000'000.0, 1.0);
}

TEST(CloudMessage, LabelsFollowTheOtherFields) {
  PointCloud cloud = four_points();
  cloud.label = {1, 2, 0, 10};
  cloud.instance = {1, 70'000, 0, 0xfffffff0};
  for (const std::uint32_t rows : {2u, 0u}) {
    cloud.rows = rows;
    if (rows == 0) cloud.return_number[2] = 1;
    const std::vector<std::uint8_t> bytes = write(cloud);
    const Message message = decode(bytes);
    EXPECT_EQ(message.data.size(), 4u * message.point_step);
    EXPECT_EQ(message.fields.at("label").type, kUint8);
    EXPECT_EQ(message.fields.at("instance").type, kUint32);
    EXPECT_EQ(message.get<std::uint8_t>("label", 3), 10);
    EXPECT_EQ(message.get<std::uint32_t>("instance", 1), 70'000u);
    EXPECT_EQ(message.get<std::uint32_t>("instance", 3), 0xfffffff0u);
    EXPECT_EQ(message.get<float>("z", 0), 12.0F);
    PointCloud back;
    CdrReader in(bytes);
    ASSERT_TRUE(RosMapping<PointCloud>::read(in, FrameNames::of_signal("rover/lidar"), back));
    EXPECT_EQ(back.label, cloud.label);
    EXPECT_EQ(back.instance, cloud.instance);
  }
}

TEST(CloudMessage, AnOrganisedOneIsDenseWhereAllWasSeen) {
  PointCloud cloud = four_points();
  cloud.return_number[2] = 1;
  EXPECT_TRUE(decode(write(cloud)).is_dense);
}

TEST(CloudMessage, RowsThatDoNotDivideThePointsMakeAList) {
  PointCloud cloud = four_points();
  cloud.rows = 3;
  const Message message = decode(write(cloud));
  EXPECT_EQ(message.height, 1u);
  EXPECT_FALSE(message.fields.contains("t"));
}

TEST(CloudMessage, ASizeThatItsPointsDoNotHaveIsNotRead) {
  const std::vector<std::uint8_t> good = write(four_points());
  const FrameNames frames = FrameNames::of_signal("rover/lidar");
  // Height and width follow the header: 4 bytes of encapsulation, the stamp, and the frame's text.
  const std::string frame = "rover/lidar";
  const std::size_t at = 4 + 8 + 4 + ((frame.size() + 1 + 3) / 4) * 4;
  const auto is_read = [&](std::uint32_t height, std::uint32_t width) {
    std::vector<std::uint8_t> bytes = good;
    std::memcpy(bytes.data() + at, &height, 4);
    std::memcpy(bytes.data() + at + 4, &width, 4);
    PointCloud cloud;
    CdrReader in(bytes);
    return RosMapping<PointCloud>::read(in, frames, cloud);
  };
  EXPECT_TRUE(is_read(2, 2));
  EXPECT_TRUE(is_read(4, 1));
  EXPECT_FALSE(is_read(0, 4));
  EXPECT_FALSE(is_read(2, 3));
  EXPECT_FALSE(is_read(0x40000001u, 0x40000000u));
  EXPECT_FALSE(is_read(0xffffffffu, 0xffffffffu));
}

}  // namespace
}  // namespace vinerow::record::cloud_message_test
