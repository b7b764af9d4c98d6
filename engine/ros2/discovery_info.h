#pragma once
/// The message that makes a participant's ROS 2 node and its topics known: `ros2 node list` and the
/// node names of `ros2 topic info -v` come from it. Internal to this folder.
///
/// Source: rmw_dds_common/msg/ParticipantEntitiesInfo, topic "ros_discovery_info" (without "rt/").

#include <string>
#include <vector>

#include "engine/record/byte_buffer.h"
#include "engine/ros2/guid.h"

namespace vinerow::ros2 {

struct DiscoveryInfo {
  std::string name_space;
  std::string node_name;
  Guid participant{};
  std::vector<Guid> readers;
  std::vector<Guid> writers;
};

constexpr const char* kDiscoveryTopic = "ros_discovery_info";
constexpr const char* kDiscoveryType = "rmw_dds_common/msg/ParticipantEntitiesInfo";

/// Definition of kDiscoveryType in Iron and later.
std::string discovery_definition();

/// Appends the message as CDR.
/// @param humble  the form of ROS 2 Humble, whose identities have 24 bytes, 8 of them zero
void write_discovery_info(const DiscoveryInfo& info, bool humble, record::ByteBuffer& out);

}  // namespace vinerow::ros2
