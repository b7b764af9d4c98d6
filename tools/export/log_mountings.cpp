#include "tools/export/log_mountings.h"

#include <set>

#include "engine/record/cdr.h"

namespace vinerow::tools {

std::vector<Mounting> read_mountings(record::McapReader& log) {
  std::set<std::uint16_t> channels;
  for (const auto& [id, channel] : log.channels()) {
    const auto schema = log.schemas().find(channel.schema);
    if (channel.topic == "/tf_static" && schema != log.schemas().end() &&
        schema->second.name == "tf2_msgs/msg/TFMessage") {
      channels.insert(id);
    }
  }
  std::vector<Mounting> mountings;
  if (channels.empty()) return mountings;
  log.for_each_message(channels, [&](const record::McapMessage& message) {
    record::CdrReader in(message.data);
    constexpr std::size_t kSmallestTransform = 72;
    const std::size_t count = in.read_count(kSmallestTransform);
    for (std::size_t i = 0; i < count; ++i) {
      Mounting mounting;
      in.read<std::int32_t>();
      in.read<std::uint32_t>();
      in.read(mounting.body);
      in.read(mounting.sensor);
      in.read(mounting.X_BS.p);
      in.read_doubles(mounting.X_BS.q.coeffs().data(), 4);  // x, y, z, w as Eigen stores them
      if (!in.ok()) return;
      mountings.push_back(mounting);
    }
  });
  return mountings;
}

}  // namespace vinerow::tools
