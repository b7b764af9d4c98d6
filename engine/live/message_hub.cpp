#include "engine/live/message_hub.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "engine/run/run_channels.h"

namespace vinerow::live {
namespace {

constexpr std::size_t kKeptEvents = 50;

/// How many last messages a viewer needs that came later.
std::size_t kept_of(std::string_view type, bool has_signal) {
  // Channels without a signal have one message, at time 0.
  if (!has_signal) return 1;
  if (type == "rcl_interfaces/msg/Log") return kKeptEvents;
  const bool is_rare = type == "nav_msgs/msg/Path" || type == "nav_msgs/msg/OccupancyGrid" ||
                       type == "visualization_msgs/msg/Marker";
  return is_rare ? 1 : 0;
}

/// True poses: a viewer of a run that is paused needs them.
bool is_pose(std::string_view topic, std::string_view type) {
  return type == "tf2_msgs/msg/TFMessage" ||
         (type == "nav_msgs/msg/Odometry" && topic.ends_with("/truth"));
}

}  // namespace

MessageHub::MessageHub(const Simulation& simulation) {
  // Not make_unique: the base is private.
  signals_.reset(new record::SignalChannels(*this, true));
  run::add_run_channels(simulation, *signals_);
  counts_ = std::make_unique<std::atomic<int>[]>(channels_.size());
  is_open_ = true;
}

MessageHub::~MessageHub() = default;

const Channel* MessageHub::find(std::uint16_t id) const {
  return id >= 1 && id <= channels_.size() ? &channels_[id - 1] : nullptr;
}

void MessageHub::subscribe(std::uint16_t id, std::shared_ptr<Subscriber> subscriber) {
  if (!find(id)) return;
  const std::lock_guard lock(mutex_);
  Audience& audience = audiences_[id - 1];
  // Under the lock, so that the next message cannot come before the kept ones.
  for (const Message& message : audience.kept) subscriber->receive(message);
  audience.subscribers.push_back(std::move(subscriber));
  ++counts_[id - 1];
  had_subscriber_ = true;
}

void MessageHub::unsubscribe(std::uint16_t id, const Subscriber* subscriber) {
  if (!find(id)) return;
  const std::lock_guard lock(mutex_);
  const auto erased = static_cast<int>(std::erase_if(
      audiences_[id - 1].subscribers, [&](const auto& each) { return each.get() == subscriber; }));
  counts_[id - 1] -= erased;
}

void MessageHub::unsubscribe_all(const Subscriber* subscriber) {
  for (const Channel& channel : channels_) unsubscribe(channel.id, subscriber);
}

void MessageHub::on_instant(Time now) {
  signals_->write_new(now);
}

void MessageHub::on_event(Time now, const Event&) {
  // Several events can fall into one instant; each is passed on before the next overwrites it.
  signals_->write_new(now);
}

std::uint16_t MessageHub::add_channel(const record::ChannelSpec& spec) {
  const bool has_signal = spec.metadata.contains("signal");
  Channel channel{spec};
  channel.id = static_cast<std::uint16_t>(channels_.size() + 1);
  channel.kept = kept_of(spec.type, has_signal);
  if (channel.kept == 0 && is_pose(spec.topic, spec.type)) {
    channel.kept = 1;
    channel.is_kept_for_clients = true;
  }
  channels_.push_back(std::move(channel));
  audiences_.emplace_back();
  return channels_.back().id;
}

bool MessageHub::wants(std::uint16_t id) const {
  const Channel& channel = channels_[id - 1];
  if (!is_open_) return true;
  const bool keeps = channel.kept > 0 && (!channel.is_kept_for_clients ||
                                          had_subscriber_.load(std::memory_order_relaxed));
  if (keeps) return true;
  if (counts_[id - 1].load(std::memory_order_relaxed) == 0) return false;
  const std::lock_guard lock(mutex_);
  const auto& subscribers = audiences_[id - 1].subscribers;
  const auto has_room = [](const auto& subscriber) { return subscriber->has_room(); };
  if (std::ranges::any_of(subscribers, has_room)) return true;
  for (const auto& subscriber : subscribers) subscriber->miss();
  return false;
}

record::ByteBuffer& MessageHub::start_message(std::uint16_t channel, std::uint64_t log_time,
                                              std::uint64_t) {
  open_ = {channel, static_cast<std::int64_t>(log_time), nullptr};
  buffer_.clear();
  return buffer_;
}

void MessageHub::end_message() {
  const auto bytes = buffer_.view();
  open_.bytes = std::make_shared<const std::vector<std::uint8_t>>(bytes.begin(), bytes.end());
  const std::lock_guard lock(mutex_);
  Audience& audience = audiences_[open_.channel - 1u];
  for (const auto& subscriber : audience.subscribers) subscriber->receive(open_);
  const std::size_t kept = channels_[open_.channel - 1u].kept;
  if (kept == 0) return;
  audience.kept.push_back(open_);
  if (audience.kept.size() > kept) audience.kept.pop_front();
}

}  // namespace vinerow::live
