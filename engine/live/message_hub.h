#pragma once
/// Messages of a run for any number of subscribers in other threads.
///
/// The run's thread encodes a message once, only if somebody subscribes to its channel, and hands
/// it to the subscribers. It never waits for them: a subscriber that cannot take a message drops
/// it.

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/record/message_sink.h"
#include "engine/record/signal_channels.h"
#include "engine/sim/run_observer.h"

namespace vinerow {
class Simulation;
}

namespace vinerow::live {

struct Channel : record::ChannelSpec {
  std::uint16_t id = 0;  ///< as in the log of the run, from 1
  /// Number of last messages that a new subscriber receives: 0 for what comes often.
  std::size_t kept = 0;
  /// Kept only once somebody has subscribed to anything, because it comes often.
  bool is_kept_for_clients = false;
};

struct Message {
  std::uint16_t channel = 0;
  std::int64_t log_time_ns = 0;
  /// Shared by all subscribers.
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;
};

class Subscriber {
 public:
  virtual ~Subscriber() = default;
  /// From the run's thread, and from subscribe() for a kept message. Must return at once.
  virtual void receive(const Message& message) = 0;
  /// False while receive() would drop everything: nothing need be encoded for it then.
  virtual bool has_room() const = 0;
  /// A message was not encoded because no subscriber had room.
  virtual void miss() = 0;
};

/// Channels of one run. A restart of the run makes another hub; a subscriber then subscribes again.
class MessageHub final : public RunObserver, private record::MessageSink {
 public:
  /// @param simulation  outlives this object's use as an observer
  explicit MessageHub(const Simulation& simulation);
  ~MessageHub() override;

  const std::vector<Channel>& channels() const { return channels_; }
  /// @returns null if there is no such channel
  const Channel* find(std::uint16_t id) const;

  // From any thread.
  void subscribe(std::uint16_t channel, std::shared_ptr<Subscriber> subscriber);
  void unsubscribe(std::uint16_t channel, const Subscriber* subscriber);
  void unsubscribe_all(const Subscriber* subscriber);

  // From the run's thread.
  void on_instant(Time now) override;
  void on_event(Time now, const Event& event) override;

 private:
  std::uint16_t add_channel(const record::ChannelSpec& spec) override;
  bool wants(std::uint16_t channel) const override;
  record::ByteBuffer& start_message(std::uint16_t channel, std::uint64_t log_time,
                                    std::uint64_t publish_time) override;
  void end_message() override;

  struct Audience {
    std::vector<std::shared_ptr<Subscriber>> subscribers;
    std::deque<Message> kept;
  };

  std::vector<Channel> channels_;
  mutable std::mutex mutex_;
  std::vector<Audience> audiences_;             ///< by channel, guarded by mutex_
  std::unique_ptr<std::atomic<int>[]> counts_;  ///< subscribers by channel
  std::atomic<bool> had_subscriber_ = false;    ///< of any channel
  bool is_open_ = false;                        ///< all channels are added
  record::ByteBuffer buffer_;
  Message open_;
  std::unique_ptr<record::SignalChannels> signals_;
};

}  // namespace vinerow::live
