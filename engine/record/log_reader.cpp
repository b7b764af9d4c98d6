#include "engine/record/log_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
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
  const ChannelInfo& channel_of(const std::string& topic,
                                const LogPass::MessageNames& names) const {
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
    std::map<std::uint16_t, std::uint64_t> latest;
    std::set<std::uint16_t> all;
    for (const ChannelInfo& channel : info.channels) {
      all.insert(static_cast<std::uint16_t>(channel.id));
    }
    mcap.for_each_message(all, [&](const McapMessage& message) {
      std::uint64_t& last = latest[message.channel];
      if (message.publish_time < last) out_of_order->insert(message.channel);
      last = std::max(last, message.publish_time);
    });
    return *out_of_order;
  }

  /// Passes a message of a topic on, or notes that it is not one.
  void take(const LogPass::Topic& topic, std::uint64_t stamp_ns, std::uint64_t index,
            std::span<const std::uint8_t> data) {
    CdrReader in(data);
    if (stamp_ns <= kLastStamp_ns && topic.take(in, topic.frames, time_of(stamp_ns))) return;
    if (!undecoded.insert({topic.channel, index}).second) return;
    const ChannelInfo& channel = channel_of_id(topic.channel);
    info.warnings.push_back(
        stamp_ns > kLastStamp_ns
            ? fmt::format("{}: message {} of topic '{}' has a stamp beyond 2^62 ns and was skipped",
                          name, index, channel.topic)
            : fmt::format("{}: message {} of topic '{}' does not hold {} and was skipped", name,
                          index, channel.topic, channel.schema));
  }

  void note_sorting(std::uint16_t channel) {
    if (!stated_as_sorted.insert(channel).second) return;
    info.warnings.push_back(
        fmt::format("{}: the messages of topic '{}' are not in the order of their stamps; they "
                    "were sorted",
                    name, channel_of_id(channel).topic));
  }

  const ChannelInfo& channel_of_id(std::uint16_t id) const {
    return *std::ranges::find(info.channels, static_cast<int>(id), &ChannelInfo::id);
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

void LogPass::add(const std::string& topic, const MessageNames& names, Take take) {
  const ChannelInfo& channel = log_.impl_->channel_of(topic, names);
  const auto signal = channel.metadata.find("signal");
  topics_.push_back(
      {static_cast<std::uint16_t>(channel.id),
       FrameNames::of_signal(signal != channel.metadata.end() ? signal->second
                                                              : topic.substr(topic.find('/') + 1)),
       std::move(take)});
}

void LogPass::run() {
  if (topics_.empty()) return;
  LogReader::Impl& log = *log_.impl_;
  struct Reading {
    std::vector<const Topic*> topics;
    bool is_sorted = true;
    std::uint64_t index = 0;
    std::vector<LogReader::Impl::KeptMessage> kept;  ///< if it is not sorted
  };
  std::map<std::uint16_t, Reading> readings;
  std::set<std::uint16_t> channels;
  for (const Topic& topic : topics_) {
    channels.insert(topic.channel);
    Reading& reading = readings[topic.channel];
    reading.topics.push_back(&topic);
    reading.is_sorted = !log.channels_out_of_order().contains(topic.channel);
  }
  log.mcap.for_each_message(channels, [&](const McapMessage& message) {
    Reading& reading = readings.at(message.channel);
    ++reading.index;
    if (!reading.is_sorted) {
      reading.kept.push_back(
          {message.publish_time, reading.index, {message.data.begin(), message.data.end()}});
      return;
    }
    for (const Topic* topic : reading.topics) {
      log.take(*topic, message.publish_time, reading.index, message.data);
    }
  });
  for (auto& [channel, reading] : readings) {
    if (reading.is_sorted) continue;
    log.note_sorting(channel);
    std::ranges::stable_sort(reading.kept, {}, &LogReader::Impl::KeptMessage::stamp_ns);
    for (const LogReader::Impl::KeptMessage& message : reading.kept) {
      for (const Topic* topic : reading.topics) {
        log.take(*topic, message.stamp_ns, message.index, message.data);
      }
    }
  }
  log.note_damage();
}

}  // namespace vinerow::record
