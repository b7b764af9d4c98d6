#include "engine/record/log_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/record/mcap_reader.h"
#include "engine/record/ros_mapping.h"

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

  /// The channel to decode T from.
  template <class T>
  const ChannelInfo& channel_of(const std::string& topic) const {
    const ChannelInfo* channel = &get(topic);
    const char* type = RosMapping<T>::kType;
    if constexpr (RosMapping<T>::kExactType != nullptr) {
      type = RosMapping<T>::kExactType;
      if (channel->schema == RosMapping<T>::kType) channel = &get(topic + "/exact");
    }
    if (channel->schema != type) {
      throw ConfigError(fmt::format("{}: topic '{}' holds {}, which is no {} ({})", name,
                                    channel->topic, channel->schema, T::kType, type));
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

template <class T>
void LogReader::read(const std::string& topic,
                     const std::function<void(Time, const T&)>& callback) const {
  const ChannelInfo& channel = impl_->channel_of<T>(topic);
  const auto signal = channel.metadata.find("signal");
  const FrameNames frames = FrameNames::of_signal(
      signal != channel.metadata.end() ? signal->second : topic.substr(topic.find('/') + 1));
  T value;
  std::uint64_t index = 0;
  impl_->mcap.for_each_message(
      {static_cast<std::uint16_t>(channel.id)}, [&](const McapMessage& message) {
        CdrReader in(message.data);
        ++index;
        if (RosMapping<T>::read(in, frames, value)) {
          callback(time_of(message.publish_time), value);
          return;
        }
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

#define VINEROW_READ(T)                                                                            \
  template void LogReader::read<T>(const std::string&, const std::function<void(Time, const T&)>&) \
      const;
VINEROW_READ(Odometry)
VINEROW_READ(ImuSample)
VINEROW_READ(GnssFix)
VINEROW_READ(RangeSample)
VINEROW_READ(PressureSample)
VINEROW_READ(MagneticSample)
VINEROW_READ(LaserScan)
VINEROW_READ(PositionEllipsoid)
VINEROW_READ(VelocityCommand)
VINEROW_READ(LocalCommand)
VINEROW_READ(LineList)
VINEROW_READ(OccupancyGrid)
VINEROW_READ(NamedValues)
VINEROW_READ(LinkPoses)
VINEROW_READ(PlannedPath)
VINEROW_READ(FollowerState)
VINEROW_READ(MovementAuthority)
VINEROW_READ(ReferenceTrajectory)
VINEROW_READ(AirReference)
VINEROW_READ(AirData)
VINEROW_READ(CameraShot)
VINEROW_READ(BatteryState)
VINEROW_READ(Event)
#undef VINEROW_READ

}  // namespace vinerow::record
