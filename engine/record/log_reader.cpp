#include "engine/record/log_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/record/mcap_reader.h"

namespace vinerow::record {
namespace {

/// Later stamps (the year 2116) are treated as damaged, so that differences of two stamps fit into
/// 64 bits.
constexpr std::uint64_t kLastStamp_ns = std::uint64_t{1} << 62;

Time time_of(std::uint64_t ns) {
  return {static_cast<std::int64_t>(ns)};
}

}  // namespace

struct LogReader::Impl {
  struct KeptMessage {
    std::uint64_t stamp_ns = 0;
    std::uint64_t index = 0;  ///< number in its channel, from 1
    std::vector<std::uint8_t> data;
  };

  explicit Impl(const std::filesystem::path& file) : name(file.string()), mcap(file) {
    info.complete = mcap.complete();
    info.first = time_of(mcap.start_time());
    info.last = time_of(mcap.end_time());
    info.messages = mcap.message_count();
    info.bytes = mcap.file_size();
    info.attachments = mcap.attachments();
    const auto take = [this](const char* record, std::map<std::string, std::string>& values) {
      const auto metadata = mcap.metadata().find(record);
      if (metadata != mcap.metadata().end()) values = metadata->second;
    };
    take("vinerow", info.metadata);
    take("vinerow_result", info.result);
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

  /// Channel from which a message is decoded.
  const ChannelInfo& channel_of(const std::string& topic, const MessageNames& names) const {
    const ChannelInfo* channel = &get(topic);
    const std::string& type = names.exact_type.empty() ? names.type : names.exact_type;
    if (!names.exact_type.empty() && channel->schema == names.type) {
      channel = &get(topic + "/exact");
    }
    if (channel->schema != type) {
      throw ConfigError(fmt::format("{}: topic '{}' holds {}, which is not {} ({})", name,
                                    channel->topic, channel->schema, names.message, type));
    }
    return *channel;
  }

  /// Channels whose stamps are not ascending; determined once by a scan of all messages.
  const std::set<std::uint16_t>& channels_out_of_order() {
    if (out_of_order) return *out_of_order;
    out_of_order.emplace();
    std::set<std::uint16_t> all;
    for (const ChannelInfo& channel : info.channels) {
      all.insert(static_cast<std::uint16_t>(channel.id));
    }
    std::map<std::uint16_t, std::uint64_t> latest;
    mcap.for_each_message(all, [&](const McapMessage& message) {
      std::uint64_t& last = latest[message.channel];
      if (message.publish_time < last) out_of_order->insert(message.channel);
      last = std::max(last, message.publish_time);
    });
    return *out_of_order;
  }

  /// Calls back for the messages of a channel in the order of their stamps.
  void for_each_in_order(const ChannelInfo& channel,
                         const std::function<void(std::uint64_t stamp_ns, std::uint64_t index,
                                                  std::span<const std::uint8_t>)>& callback) {
    const auto id = static_cast<std::uint16_t>(channel.id);
    const bool is_sorted = !channels_out_of_order().contains(id);
    std::vector<KeptMessage> kept;
    std::uint64_t index = 0;
    mcap.for_each_message({id}, [&](const McapMessage& message) {
      ++index;
      if (is_sorted) {
        callback(message.publish_time, index, message.data);
      } else {
        kept.push_back({message.publish_time, index, {message.data.begin(), message.data.end()}});
      }
    });
    if (is_sorted) return;
    if (stated_as_sorted.insert(channel.id).second) {
      info.warnings.push_back(
          fmt::format("{}: the messages of topic '{}' are not in the order of their stamps; they "
                      "were sorted",
                      name, channel.topic));
    }
    std::ranges::stable_sort(kept, {}, &KeptMessage::stamp_ns);
    for (const KeptMessage& message : kept) callback(message.stamp_ns, message.index, message.data);
  }

  void note_damage() {
    // The MCAP reader appends warnings; warnings about undecoded messages are interleaved.
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
  std::optional<std::set<std::uint16_t>> out_of_order;
  std::set<int> stated_as_sorted;  ///< channels
};

LogReader::LogReader(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) {}

LogReader::~LogReader() = default;

const LogInfo& LogReader::info() const {
  return impl_->info;
}

bool LogReader::has_topic(const std::string& topic) const {
  return impl_->find(topic) != nullptr;
}

void LogReader::read_messages(
    const std::string& topic, const MessageNames& names,
    const std::function<bool(CdrReader&, const FrameNames&, Time)>& take) const {
  const ChannelInfo& channel = impl_->channel_of(topic, names);
  const auto signal = channel.metadata.find("signal");
  const FrameNames frames = FrameNames::of_signal(
      signal != channel.metadata.end() ? signal->second : topic.substr(topic.find('/') + 1));
  impl_->for_each_in_order(channel, [&](std::uint64_t stamp_ns, std::uint64_t index,
                                        std::span<const std::uint8_t> data) {
    CdrReader in(data);
    if (stamp_ns <= kLastStamp_ns && take(in, frames, time_of(stamp_ns))) return;
    if (!impl_->undecoded.insert({channel.id, index}).second) return;
    impl_->info.warnings.push_back(
        stamp_ns > kLastStamp_ns
            ? fmt::format("{}: message {} of topic '{}' has a stamp beyond 2^62 ns and was skipped",
                          impl_->name, index, channel.topic)
            : fmt::format("{}: message {} of topic '{}' does not hold {} and was skipped",
                          impl_->name, index, channel.topic, channel.schema));
  });
  impl_->note_damage();
}

}  // namespace vinerow::record
