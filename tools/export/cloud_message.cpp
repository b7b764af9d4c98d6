#include "tools/export/cloud_message.h"

#include <array>

#include "engine/io/files/utf8.h"

namespace vinerow::tools {
namespace {

using record::RosKind;

/// @param datatype  constant of sensor_msgs/PointField
std::optional<RosKind> kind_of(std::uint8_t datatype) {
  constexpr std::array kKinds = {RosKind::kInt8,    RosKind::kUint8,  RosKind::kInt16,
                                 RosKind::kUint16,  RosKind::kInt32,  RosKind::kUint32,
                                 RosKind::kFloat32, RosKind::kFloat64};
  if (datatype < 1 || datatype > kKinds.size()) return std::nullopt;
  return kKinds[datatype - 1];
}

std::vector<CloudField> read_fields(record::CdrReader& in) {
  constexpr std::size_t kSmallestField = 16;
  std::vector<CloudField> fields;
  const std::size_t count = in.read_count(kSmallestField);
  for (std::size_t i = 0; i < count && in.ok(); ++i) {
    CloudField field;
    in.read(field.name);
    field.name = io::valid_utf8(field.name);
    field.offset = in.read<std::uint32_t>();
    const auto kind = kind_of(in.read<std::uint8_t>());
    const bool is_one_number = in.read<std::uint32_t>() == 1;
    if (!kind || !is_one_number) continue;
    field.kind = *kind;
    fields.push_back(field);
  }
  return fields;
}

}  // namespace

bool is_cloud_type(const std::string& ros_type) {
  return ros_type == "sensor_msgs/msg/PointCloud2";
}

std::optional<CloudMessage> read_cloud(record::CdrReader& in) {
  CloudMessage cloud;
  cloud.height = in.read<std::uint32_t>();
  cloud.width = in.read<std::uint32_t>();
  cloud.fields = read_fields(in);
  const bool is_big_endian = in.read_bool();
  cloud.point_step = in.read<std::uint32_t>();
  cloud.row_step = in.read<std::uint32_t>();
  cloud.data.resize(in.read_count(1));
  in.read_octets(cloud.data.data(), cloud.data.size());
  in.read_bool();
  if (!in.ok() || is_big_endian) return std::nullopt;
  // The bytes of the message bound the points. 32-bit counts do not overflow in 64 bits.
  if (cloud.size() == 0) return cloud;
  const bool fits = cloud.point_step > 0 && cloud.row_step / cloud.point_step >= cloud.width &&
                    cloud.data.size() / cloud.row_step >= cloud.height;
  if (!fits) return std::nullopt;
  for (const CloudField& field : cloud.fields) {
    if (std::uint64_t{field.offset} + record::size_of(field.kind) > cloud.point_step) {
      return std::nullopt;
    }
  }
  return cloud;
}

}  // namespace vinerow::tools
