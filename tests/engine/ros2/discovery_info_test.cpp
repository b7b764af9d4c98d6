/// Bytes of the discovery message, composed by hand from
/// rmw_dds_common/msg/ParticipantEntitiesInfo.

#include "engine/ros2/discovery_info.h"

#include <gtest/gtest.h>

namespace vinerow::ros2::discovery_info_test {
namespace {

Guid guid_of_ones(std::uint8_t value) {
  Guid guid;
  guid.fill(value);
  return guid;
}

std::vector<std::uint8_t> message(bool humble) {
  DiscoveryInfo info;
  info.name_space = "/a";
  info.node_name = "b";
  info.participant = guid_of_ones(1);
  info.writers = {guid_of_ones(2)};
  record::ByteBuffer buffer;
  write_discovery_info(info, humble, buffer);
  return {buffer.data(), buffer.data() + buffer.size()};
}

std::vector<std::uint8_t> expected(std::size_t zeros) {
  std::vector<std::uint8_t> bytes = {0, 1, 0, 0};
  const auto add = [&](std::initializer_list<std::uint8_t> more) {
    bytes.insert(bytes.end(), more);
  };
  bytes.insert(bytes.end(), 16, 1);
  bytes.insert(bytes.end(), zeros, 0);
  add({1, 0, 0, 0});                  // one node
  add({3, 0, 0, 0, '/', 'a', 0, 0});  // namespace, padding
  add({2, 0, 0, 0, 'b', 0, 0, 0});    // name, padding
  add({0, 0, 0, 0});                  // readers
  add({1, 0, 0, 0});                  // writers
  bytes.insert(bytes.end(), 16, 2);
  bytes.insert(bytes.end(), zeros, 0);
  return bytes;
}

TEST(DiscoveryInfo, HasIdentitiesOf16Bytes) {
  EXPECT_EQ(message(false), expected(0));
}

TEST(DiscoveryInfo, HasIdentitiesOf24BytesForHumble) {
  EXPECT_EQ(message(true), expected(8));
}

}  // namespace
}  // namespace vinerow::ros2::discovery_info_test
