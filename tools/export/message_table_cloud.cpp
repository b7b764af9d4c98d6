/// Clouds in a table.

#include "tools/export/cloud_message.h"
#include "tools/export/message_table.h"

namespace vinerow::tools {

bool MessageTable::decode_cloud(record::CdrReader& in) {
  const auto cloud = read_cloud(in);
  if (!cloud) return false;
  if (cloud->size() == 0) return true;
  for (const CloudField& field : cloud->fields) {
    const std::size_t size = record::size_of(field.kind);
    const std::size_t place = column(field.name, field.kind, false);
    // A field that has changed its type between messages is not the same column.
    if (columns_[place].kind != field.kind) return false;
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      leaves_.push_back({place, static_cast<int>(i), 1, numbers_.size()});
      numbers_.append(reinterpret_cast<const char*>(cloud->point(i) + field.offset), size);
    }
  }
  elements_ = static_cast<std::uint32_t>(cloud->size());
  return true;
}

}  // namespace vinerow::tools
