#include "engine/record/recorder.h"

#include <vinerow/version.h>
#include <chrono>
#include <map>
#include <utility>

#include "engine/core/error.h"
#include "engine/record/mcap_writer.h"

namespace vinerow::record {

using WallClock = std::chrono::steady_clock;

/// Channels and messages as MCAP has them: a channel refers to a schema.
class McapSink final : public MessageSink {
 public:
  explicit McapSink(McapWriter& writer) : writer_(writer) {}

  std::uint16_t add_channel(const ChannelSpec& channel) override {
    // Two plug-ins may use one name for different definitions.
    std::uint16_t& schema = schemas_[{channel.type, channel.definition}];
    if (schema == 0) schema = writer_.add_schema(channel.type, "ros2msg", channel.definition);
    return writer_.add_channel(schema, channel.topic, "cdr", channel.metadata);
  }
  ByteBuffer& start_message(std::uint16_t channel, std::uint64_t log_time,
                            std::uint64_t publish_time) override {
    return writer_.start_message(channel, log_time, publish_time);
  }
  void end_message() override { writer_.end_message(); }

 private:
  McapWriter& writer_;
  std::map<std::pair<std::string, std::string>, std::uint16_t> schemas_;  ///< type, definition
};

struct Recorder::Impl {
  Impl(const std::filesystem::path& file, const RecorderOptions& options)
      : path(file),
        chunk_bytes(options.chunk_bytes),
        flush_period(std::chrono::duration_cast<WallClock::duration>(
            std::chrono::duration<double>(options.flush_wall_s))),
        writer(file, options.compression, options.chunk_bytes, "ros2",
               "vinerow " VINEROW_VERSION_STRING),
        sink(writer),
        channels(sink, options.compact_poses) {}

  void throw_on_failure(Time now) {
    if (failed || writer.failure().empty()) return;
    failed = true;
    throw SimulationError("recorder", now,
                          path.string() + ": the log cannot be written: " + writer.failure());
  }

  std::filesystem::path path;
  std::size_t chunk_bytes;
  WallClock::duration flush_period;
  McapWriter writer;
  McapSink sink;
  SignalChannels channels;
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
    // A destructor cannot report failures; call finish() to see them.
  }
}

SignalChannels& Recorder::channels() {
  return impl_->channels;
}

void Recorder::record(Time now) {
  Impl& impl = *impl_;
  if (impl.finished || impl.failed) return;
  impl.last_now = now;
  impl.channels.write_new(now);
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

void Recorder::add_result(const std::map<std::string, std::string>& values) {
  if (!impl_->finished) impl_->writer.add_metadata("vinerow_result", values);
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
