#include "engine/ros2/discovery_info.h"

#include "engine/record/cdr.h"

namespace vinerow::ros2 {
namespace {

void write_identity(record::CdrWriter& out, const Guid& guid, bool humble) {
  constexpr std::uint8_t kZeros[8] = {};
  out.add_numbers(guid.data(), guid.size(), 1);
  if (humble) out.add_numbers(kZeros, sizeof kZeros, 1);
}

void write_identities(record::CdrWriter& out, const std::vector<Guid>& guids, bool humble) {
  out.add_count(guids.size());
  for (const Guid& guid : guids) write_identity(out, guid, humble);
}

}  // namespace

std::string discovery_definition() {
  return "Gid gid\nNodeEntitiesInfo[] node_entities_info_seq\n"
         "===\nMSG: rmw_dds_common/NodeEntitiesInfo\n"
         "string<=256 node_namespace\nstring<=256 node_name\nGid[] reader_gid_seq\n"
         "Gid[] writer_gid_seq\n"
         "===\nMSG: rmw_dds_common/Gid\nchar[16] data\n";
}

void write_discovery_info(const DiscoveryInfo& info, bool humble, record::ByteBuffer& out) {
  record::CdrWriter cdr(out);
  write_identity(cdr, info.participant, humble);
  cdr.add_count(1);  // nodes of this participant
  cdr.add(std::string_view(info.name_space));
  cdr.add(std::string_view(info.node_name));
  write_identities(cdr, info.readers, humble);
  write_identities(cdr, info.writers, humble);
}

}  // namespace vinerow::ros2
