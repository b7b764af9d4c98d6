/// Clouds in a table.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/export/message_table.h"
#include "tools/export/utf8.h"

namespace vinerow::tools {
namespace {

using record::RosKind;

struct CloudField {
  std::string name;
  std::uint32_t offset = 0;
  std::optional<RosKind> kind;  ///< absent: not a single number
};

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
  std::vector<CloudField> fields(in.read_count(kSmallestField));
  for (CloudField& field : fields) {
    in.read(field.name);
    field.name = valid_utf8(field.name);
    field.offset = in.read<std::uint32_t>();
    field.kind = kind_of(in.read<std::uint8_t>());
    if (in.read<std::uint32_t>() != 1) field.kind.reset();
  }
  return fields;
}

}  // namespace

bool MessageTable::decode_cloud(record::CdrReader& in) {
  const auto height = in.read<std::uint32_t>(), width = in.read<std::uint32_t>();
  const std::vector<CloudField> fields = read_fields(in);
  const bool is_big_endian = in.read_bool();
  const auto point_step = in.read<std::uint32_t>(), row_step = in.read<std::uint32_t>();
  std::vector<std::uint8_t> data(in.read_count(1));
  in.read_octets(data.data(), data.size());
  in.read_bool();
  // The bytes of the message bound the points. 32-bit counts do not overflow in 64 bits.
  const std::uint64_t points = std::uint64_t{height} * width;
  const bool fits = points == 0 || (point_step > 0 && row_step / point_step >= width &&
                                    data.size() / row_step >= height);
  if (!in.ok() || is_big_endian || !fits) return false;
  if (points == 0) return true;
  for (const CloudField& field : fields) {
    if (!field.kind) continue;
    const std::size_t size = record::size_of(*field.kind);
    if (std::uint64_t{field.offset} + size > point_step) return false;
    const std::size_t place = column(field.name, *field.kind, false);
    // A field that has changed its type between messages is not the same column.
    if (columns_[place].kind != *field.kind) return false;
    int row = 0;
    for (std::uint32_t j = 0; j < height; ++j) {
      for (std::uint32_t i = 0; i < width; ++i, ++row) {
        const std::size_t at =
            std::size_t{j} * row_step + std::size_t{i} * point_step + field.offset;
        leaves_.push_back({place, row, 1, numbers_.size()});
        numbers_.append(reinterpret_cast<const char*>(data.data() + at), size);
      }
    }
  }
  elements_ = static_cast<std::uint32_t>(points);
  return true;
}

}  // namespace vinerow::tools
