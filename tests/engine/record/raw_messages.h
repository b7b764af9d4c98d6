#pragma once
/// Every message of a log as bytes, in the file's order: what LogReader decodes, undecoded.

#include <functional>
#include <map>
#include <set>
#include <vector>

#include "engine/record/log_reader.h"
#include "engine/record/mcap_reader.h"

namespace vinerow::test {

/// With their log time. @throws ConfigError as LogReader
inline void read_raw(const std::filesystem::path& file,
                     const std::function<void(Time, const record::ChannelInfo&,
                                              const std::vector<std::uint8_t>&)>& callback) {
  const record::LogReader log(file);
  std::map<std::uint16_t, const record::ChannelInfo*> by_id;
  std::set<std::uint16_t> ids;
  for (const record::ChannelInfo& channel : log.info().channels) {
    by_id[static_cast<std::uint16_t>(channel.id)] = &channel;
    ids.insert(static_cast<std::uint16_t>(channel.id));
  }
  record::McapReader(file).for_each_message(ids, [&](const record::McapMessage& message) {
    callback(Time{static_cast<std::int64_t>(message.log_time)}, *by_id.at(message.channel),
             {message.data.begin(), message.data.end()});
  });
}

}  // namespace vinerow::test
