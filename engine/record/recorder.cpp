#include "engine/record/recorder.h"

#include <chrono>
#include <vector>

#include "engine/api/messages.h"
#include "engine/core/error.h"
#include "engine/record/mcap_writer.h"
#include "engine/record/ros_definitions.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {

using WallClock = std::chrono::steady_clock;

struct RecordedSignal {
  const SignalBase* signal = nullptr;
  Duration min_period;
  FrameNames frames;
  const Signal<Odometry>* truth = nullptr;  ///< of the same vehicle
  std::uint16_t channel = 0;
  std::uint16_t exact_channel = 0;  ///< 0: none
  std::uint64_t seen = 0;
  bool recorded = false;
  Time last_stamp;
  void (*write)(McapWriter&, const RecordedSignal&, Time now) = nullptr;
};

namespace {

template <class T>
void write_messages(McapWriter& writer, const RecordedSignal& entry, Time now) {
  const T& value = static_cast<const Signal<T>&>(*entry.signal).value();
  const Time stamp = entry.signal->stamp();
  const bool is_body_known =
      entry.truth != nullptr && entry.truth->sequence() > 0 && entry.truth->stamp() == stamp;
  const WriteContext context{entry.frames, stamp,
                             is_body_known ? &entry.truth->value().X_WB : nullptr};
  const auto log_time = static_cast<std::uint64_t>(now.ns);
  const auto publish_time = static_cast<std::uint64_t>(stamp.ns);
  {
    CdrWriter out(writer.begin_message(entry.channel, log_time, publish_time));
    RosMapping<T>::write(out, context, value);
    writer.end_message();
  }
  if constexpr (RosMapping<T>::kExactType != nullptr) {
    CdrWriter out(writer.begin_message(entry.exact_channel, log_time, publish_time));
    RosMapping<T>::write_exact(out, context, value);
    writer.end_message();
  }
}

}  // namespace

struct Recorder::Impl {
  Impl(const std::filesystem::path& file, const RecorderOptions& options)
      : path(file),
        chunk_bytes(options.chunk_bytes),
        compact_poses(options.compact_poses),
        flush_period(std::chrono::duration_cast<WallClock::duration>(
            std::chrono::duration<double>(options.flush_wall_s))),
        writer(file, options.compression, options.chunk_bytes, "ros2",
               std::string("vinerow ") + VINEROW_VERSION) {}

  std::uint16_t schema_id(const char* type) {
    const auto found = schema_ids.find(type);
    if (found != schema_ids.end()) return found->second;
    const std::uint16_t id = writer.add_schema(type, "ros2msg", full_ros_definition(type));
    schema_ids.emplace(type, id);
    return id;
  }

  std::uint16_t add_channel(const SignalBase& signal, const char* type, const std::string& suffix) {
    // offered_qos_profiles: asked for by the ros2 profile; an empty list: nothing was published.
    TextMap metadata = {{"signal", signal.name()}, {"offered_qos_profiles", "[]"}};
    if (suffix.empty()) {
      metadata["vinerow_type"] = signal.type();
    } else {
      metadata["exact_of"] = "/" + signal.name();
    }
    return writer.add_channel(schema_id(type), "/" + signal.name() + suffix, "cdr", metadata);
  }

  template <class T>
  void set_type(RecordedSignal& entry) {
    if (std::string_view(entry.signal->type()) != T::kType) return;
    entry.write = &write_messages<T>;
    entry.channel = add_channel(*entry.signal, RosMapping<T>::kType, "");
    if constexpr (RosMapping<T>::kExactType != nullptr) {
      entry.exact_channel = add_channel(*entry.signal, RosMapping<T>::kExactType, "/exact");
    }
  }

  /// Every signal learns where its vehicle is from "<vehicle>/truth", in whatever order they come.
  void connect_truth() {
    for (const RecordedSignal& truth : entries) {
      if (truth.signal->name() != truth.frames.prefix + "truth") continue;
      if (std::string_view(truth.signal->type()) != Odometry::kType) continue;
      for (RecordedSignal& entry : entries) {
        if (entry.frames.prefix != truth.frames.prefix) continue;
        entry.truth = static_cast<const Signal<Odometry>*>(truth.signal);
      }
    }
  }

  void throw_on_failure(Time now) {
    if (failed || writer.failure().empty()) return;
    failed = true;
    throw SimulationError("recorder", now,
                          path.string() + ": the log cannot be written: " + writer.failure());
  }

  std::filesystem::path path;
  std::size_t chunk_bytes;
  bool compact_poses;
  WallClock::duration flush_period;
  McapWriter writer;
  std::map<std::string, std::uint16_t> schema_ids;
  std::vector<RecordedSignal> entries;
  WallClock::time_point last_flush = WallClock::now();
  Time last_now;
  bool finished = false;
  bool failed = false;
};

Recorder::Recorder(const std::filesystem::path& file, const RecorderOptions& options,
                   const std::map<std::string, std::string>& metadata)
    : impl_(std::make_unique<Impl>(file, options)) {
  impl_->writer.add_metadata("vinerow", metadata);
}

Recorder::~Recorder() {
  try {
    finish();
  } catch (const SimulationError&) {
    // Who wants to know calls finish(); a destructor cannot tell.
  }
}

void Recorder::add_signal(const SignalBase& signal, Duration min_period) {
  RecordedSignal entry;
  entry.signal = &signal;
  entry.min_period = min_period;
  entry.frames = FrameNames::of_signal(signal.name());
  for_each_message_type([&]<class T>(T*) { impl_->set_type<T>(entry); });
  VINEROW_DEMAND(entry.write != nullptr);
  impl_->entries.push_back(std::move(entry));
  if (impl_->compact_poses) impl_->connect_truth();
}

void Recorder::record(Time now) {
  Impl& impl = *impl_;
  if (impl.finished || impl.failed) return;
  impl.last_now = now;
  for (RecordedSignal& entry : impl.entries) {
    if (entry.signal->sequence() == entry.seen) continue;
    entry.seen = entry.signal->sequence();
    const Time stamp = entry.signal->stamp();
    const bool thinned = entry.min_period.ns > 0 && entry.recorded;
    if (thinned && stamp - entry.last_stamp < entry.min_period) continue;
    entry.recorded = true;
    entry.last_stamp = stamp;
    entry.write(impl.writer, entry, now);
  }
  if (impl.writer.open_bytes() == 0) return;
  const WallClock::time_point wall = WallClock::now();
  if (impl.writer.open_bytes() < impl.chunk_bytes && wall - impl.last_flush < impl.flush_period) {
    return;
  }
  impl.writer.close_chunk();
  impl.last_flush = wall;
  impl.throw_on_failure(now);
}

void Recorder::add_attachment(const std::string& name, const std::string& media_type,
                              const std::string& content) {
  if (!impl_->finished) impl_->writer.add_attachment(name, media_type, content);
}

void Recorder::finish() {
  if (impl_->finished) return;
  impl_->finished = true;
  impl_->writer.finish();
  impl_->throw_on_failure(impl_->last_now);
}

std::uint64_t Recorder::bytes_written() const {
  return impl_->writer.bytes_written();
}

std::uint64_t Recorder::message_count() const {
  return impl_->writer.message_count();
}

}  // namespace vinerow::record
