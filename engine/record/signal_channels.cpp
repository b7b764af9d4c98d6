#include "engine/record/signal_channels.h"

#include <utility>

#include "engine/api/messages.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {

struct RecordedSignal {
  const SignalBase* signal = nullptr;
  Duration min_period;
  FrameNames frames;
  const Signal<Odometry>* truth = nullptr;           ///< of the same vehicle
  const Signal<DeadReckoning>* reckoning = nullptr;  ///< likewise, the first
  std::uint16_t channel = 0;                         ///< 0: only the exact channel
  std::uint16_t exact_channel = 0;                   ///< 0: none
  bool recorded = false;
  Time last_stamp;
  void (*write)(MessageSink&, const RecordedSignal&, Time now) = nullptr;
};

namespace {

WriteContext context_of(const RecordedSignal& entry) {
  const Time stamp = entry.signal->stamp();
  const auto is_known = [&](const auto* signal) {
    return signal != nullptr && signal->sequence() > 0 && signal->stamp() == stamp;
  };
  return {entry.frames, stamp, is_known(entry.truth) ? &entry.truth->value().X_WB : nullptr,
          is_known(entry.reckoning) ? &entry.reckoning->value().X_OB : nullptr};
}

template <class T>
void write_messages(MessageSink& sink, const RecordedSignal& entry, Time now) {
  const T& value = static_cast<const Signal<T>&>(*entry.signal).value();
  const Time stamp = entry.signal->stamp();
  const WriteContext context = context_of(entry);
  const auto log_time = static_cast<std::uint64_t>(now.ns);
  const auto publish_time = static_cast<std::uint64_t>(stamp.ns);
  if (entry.channel != 0 && sink.wants(entry.channel)) {
    CdrWriter out(sink.start_message(entry.channel, log_time, publish_time));
    RosMapping<T>::write(out, context, value);
    sink.end_message();
  }
  if constexpr (requires { &RosMapping<T>::write_exact; }) {
    if (!sink.wants(entry.exact_channel)) return;
    CdrWriter out(sink.start_message(entry.exact_channel, log_time, publish_time));
    RosMapping<T>::write_exact(out, context, value);
    sink.end_message();
  }
}

/// Fields of a signal whose type is known only to its plug-in.
class FieldsOfSignal final : public MessageFields {
 public:
  explicit FieldsOfSignal(const SignalBase& signal) : signal_(signal) {}
  void visit(FieldVisitor& visitor) const override { signal_.describe(visitor); }

 private:
  const SignalBase& signal_;
};

void write_described_signal(MessageSink& sink, const RecordedSignal& entry, Time now) {
  if (!sink.wants(entry.channel)) return;
  const SignalBase& signal = *entry.signal;
  CdrWriter out(sink.start_message(entry.channel, static_cast<std::uint64_t>(now.ns),
                                   static_cast<std::uint64_t>(signal.stamp().ns)));
  write_described(out, context_of(entry), signal.message_type().frame, {}, FieldsOfSignal(signal));
  sink.end_message();
}

/// QoS profile as rosbag2 stores it: late subscribers also receive the message (reliable, transient
/// local).
constexpr const char* kLatchedQos =
    "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n"
    "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  liveliness: 1\n"
    "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false\n";

}  // namespace

struct SignalChannels::Impl {
  /// Adds a channel with one message at time 0.
  template <class F>
  void add_once(const std::string& topic, const std::string& type, const F& write) {
    const std::uint16_t channel = sink.add_channel(
        {topic, type, full_ros_definition(type), {{"offered_qos_profiles", kLatchedQos}}});
    CdrWriter out(sink.start_message(channel, 0, 0));
    write(out);
    sink.end_message();
  }

  std::uint16_t add_channel(const SignalBase& signal, const std::string& type,
                            const std::string& definition, std::string_view suffix) {
    // The ros2 profile requires offered_qos_profiles; an empty list means that nothing was
    // published.
    TextMap metadata = {{"signal", signal.name()}, {"offered_qos_profiles", "[]"}};
    // The commands that a replay needs.
    if (signal.writer() == kOutside) metadata["writer"] = kOutside;
    if (suffix.empty()) {
      metadata["vinerow_type"] = signal.type();
    } else {
      metadata["exact_of"] = "/" + signal.name();
    }
    return sink.add_channel(
        {"/" + signal.name() + std::string(suffix), type, definition, std::move(metadata)});
  }

  template <class T>
  void set_type(RecordedSignal& entry, bool exact_alone) {
    if (!is_message<T>(*entry.signal)) return;
    using Mapping = RosMapping<T>;
    entry.write = &write_messages<T>;
    if constexpr (requires { &Mapping::write_exact; }) {
      if (exact_alone) {
        entry.exact_channel =
            add_channel(*entry.signal, Mapping::exact_type(), Mapping::exact_definition(), "");
        return;
      }
    }
    entry.channel = add_channel(*entry.signal, Mapping::type(), Mapping::definition(), "");
    if constexpr (requires { &Mapping::write_exact; }) {
      entry.exact_channel =
          add_channel(*entry.signal, Mapping::exact_type(), Mapping::exact_definition(), "/exact");
    }
  }

  /// Sets the mapping of a plug-in's type.
  void set_described_type(RecordedSignal& entry) {
    const std::string type = ros_type_of(entry.signal->type());
    entry.write = &write_described_signal;
    entry.channel = add_channel(*entry.signal, type,
                                described_definition(type, {}, FieldsOfSignal(*entry.signal)), "");
  }

  /// Connects each signal to "<vehicle>/truth" for the vehicle's pose and to its dead reckoning, in
  /// any order of signals.
  void connect_poses() {
    for (const RecordedSignal& source : entries) {
      const SignalBase& signal = *source.signal;
      const bool is_truth =
          signal.name() == source.frames.prefix + "truth" && is_message<Odometry>(signal);
      const bool is_reckoning =
          is_message<DeadReckoning>(signal) && !signal.name().ends_with("_truth");
      if (!is_truth && !is_reckoning) continue;
      for (RecordedSignal& entry : entries) {
        if (entry.frames.prefix != source.frames.prefix) continue;
        if (is_truth) entry.truth = static_cast<const Signal<Odometry>*>(&signal);
        if (is_reckoning && entry.reckoning == nullptr) {
          entry.reckoning = static_cast<const Signal<DeadReckoning>*>(&signal);
        }
      }
    }
  }

  MessageSink& sink;
  bool compact_poses = true;
  /// What every step reads, close together.
  struct Watched {
    const SignalBase* signal;
    std::uint64_t seen;
  };
  std::vector<RecordedSignal> entries;
  std::vector<Watched> watched;  ///< of each entry
};

SignalChannels::SignalChannels(MessageSink& sink, bool compact_poses)
    : impl_(new Impl{sink, compact_poses, {}, {}}) {}

SignalChannels::~SignalChannels() = default;

void SignalChannels::add_static_transforms(const std::vector<StaticTransform>& transforms) {
  if (transforms.empty()) return;
  impl_->add_once("/tf_static", "tf2_msgs/msg/TFMessage",
                  [&](CdrWriter& out) { write_static_transforms(out, transforms); });
}

void SignalChannels::add_scene(const std::vector<SceneEntity>& entities) {
  if (entities.empty()) return;
  impl_->add_once("/run/scene", "foxglove_msgs/msg/SceneUpdate",
                  [&](CdrWriter& out) { write_scene(out, entities); });
}

void SignalChannels::add_signal(const SignalBase& signal, Duration min_period,
                                const std::string& frame, bool exact_alone) {
  RecordedSignal entry;
  entry.signal = &signal;
  entry.min_period = min_period;
  entry.frames = FrameNames::of_signal(signal.name());
  if (!frame.empty()) entry.frames.own = frame;
  for_each_message_type([&]<class T>(T*) { impl_->set_type<T>(entry, exact_alone); });
  if (entry.write == nullptr) impl_->set_described_type(entry);
  impl_->entries.push_back(std::move(entry));
  impl_->watched.push_back({&signal, 0});
  if (impl_->compact_poses) impl_->connect_poses();
}

void SignalChannels::write_new(Time now) {
  RecordedSignal* next = impl_->entries.data();
  for (Impl::Watched& watched : impl_->watched) {
    RecordedSignal& entry = *next++;
    if (watched.signal->sequence() == watched.seen) continue;
    watched.seen = watched.signal->sequence();
    const Time stamp = entry.signal->stamp();
    const bool thinned = entry.min_period.ns > 0 && entry.recorded;
    if (thinned && stamp - entry.last_stamp < entry.min_period) continue;
    entry.recorded = true;
    entry.last_stamp = stamp;
    entry.write(impl_->sink, entry, now);
  }
}

}  // namespace vinerow::record
