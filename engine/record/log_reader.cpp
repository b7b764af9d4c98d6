#include "engine/record/log_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/record/mcap_reader.h"

namespace vinerow::record {
namespace {

Time time_of(std::uint64_t ns) {
  return {static_cast<std::int64_t>(ns)};
}

}  // namespace

struct LogReader::Impl {
  explicit Impl(const std::filesystem::path& file) : name(file.string()), mcap(file) {
    info.complete = mcap.complete();
    info.first = time_of(mcap.start_time());
    info.last = time_of(mcap.end_time());
    info.messages = mcap.message_count();
    info.bytes = mcap.file_size();
    info.attachments = mcap.attachments();
    const auto metadata = mcap.metadata().find("vinerow");
    if (metadata != mcap.metadata().end()) info.metadata = metadata->second;
    for (const auto& [id, channel] : mcap.channels()) {
      const auto schema = mcap.schemas().find(channel.schema);
      info.channels.push_back({.id = id,
                               .topic = channel.topic,
                               .schema = schema == mcap.schemas().end() ? "" : schema->second.name,
                               .messages = channel.messages,
                               .metadata = channel.metadata});
    }
    note_damage();
  }

  const ChannelInfo* find(const std::string& topic) const {
    const auto found = std::ranges::find(info.channels, topic, &ChannelInfo::topic);
    return found == info.channels.end() ? nullptr : &*found;
  }

  const ChannelInfo& get(const std::string& topic) const {
    if (const ChannelInfo* channel = find(topic)) return *channel;
    std::vector<std::string> topics;
    for (const ChannelInfo& channel : info.channels) topics.push_back(channel.topic);
    throw ConfigError(fmt::format("{}: no topic '{}'{} (there are: {})", name, topic,
                                  did_you_mean(topic, topics), join(topics)));
  }

  /// The channel to decode a message from.
  const ChannelInfo& channel_of(const std::string& topic, const MessageNames& names) const {
    const ChannelInfo* channel = &get(topic);
    const std::string& type = names.exact_type.empty() ? names.type : names.exact_type;
    if (!names.exact_type.empty() && channel->schema == names.type) {
      channel = &get(topic + "/exact");
    }
    if (channel->schema != type) {
      throw ConfigError(fmt::format("{}: topic '{}' holds {}, which is no {} ({})", name,
                                    channel->topic, channel->schema, names.message, type));
    }
    return *channel;
  }

  void note_damage() {
    // The reader below appends; messages that could not be decoded stand between.
    for (; mcap_warnings < mcap.warnings().size(); ++mcap_warnings) {
      info.warnings.push_back(mcap.warnings()[mcap_warnings]);
    }
    info.damaged = mcap.damaged_chunks() + undecoded.size();
  }

  std::string name;
  McapReader mcap;
  LogInfo info;
  std::size_t mcap_warnings = 0;
  std::set<std::pair<int, std::uint64_t>> undecoded;  ///< channel, number in it
};

LogReader::LogReader(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) {}

LogReader::~LogReader() = default;

const LogInfo& LogReader::info() const {
  return impl_->info;
}

bool LogReader::has_topic(const std::string& topic) const {
  return impl_->find(topic) != nullptr;
}

void LogReader::read_messages(const std::string& topic, const MessageNames& names,
                              const std::function<bool(CdrReader&, const FrameNames&, Time)>& take)
    const {
  const ChannelInfo& channel = impl_->channel_of(topic, names);
  const auto signal = channel.metadata.find("signal");
  const FrameNames frames = FrameNames::of_signal(
      signal != channel.metadata.end() ? signal->second : topic.substr(topic.find('/') + 1));
  std::uint64_t index = 0;
  impl_->mcap.for_each_message(
      {static_cast<std::uint16_t>(channel.id)}, [&](const McapMessage& message) {
        CdrReader in(message.data);
        ++index;
        if (take(in, frames, time_of(message.publish_time))) return;
        if (!impl_->undecoded.insert({channel.id, index}).second) return;
        impl_->info.warnings.push_back(
            fmt::format("{}: message {} of topic '{}' does not hold {} and was left out",
                        impl_->name, index, channel.topic, channel.schema));
      });
  impl_->note_damage();
}

void LogReader::read_raw(
    const std::function<void(Time, const ChannelInfo&, const std::vector<std::uint8_t>&)>& callback)
    const {
  std::set<std::uint16_t> ids;
  std::map<std::uint16_t, const ChannelInfo*> by_id;
  for (const ChannelInfo& channel : impl_->info.channels) {
    ids.insert(static_cast<std::uint16_t>(channel.id));
    by_id[static_cast<std::uint16_t>(channel.id)] = &channel;
  }
  std::vector<std::uint8_t> data;
  impl_->mcap.for_each_message(ids, [&](const McapMessage& message) {
    data.assign(message.data.begin(), message.data.end());
    callback(time_of(message.log_time), *by_id.at(message.channel), data);
  });
  impl_->note_damage();
}

}  // namespace vinerow::record
