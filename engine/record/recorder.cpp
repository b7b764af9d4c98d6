#include "engine/record/recorder.h"

#include <vinerow/version.h>
#include <chrono>
#include <utility>

#include "engine/core/error.h"
#include "engine/record/mcap_writer.h"

namespace vinerow::record {

using WallClock = std::chrono::steady_clock;

struct Recorder::Impl {
  Impl(const std::filesystem::path& file, const RecorderOptions& options)
      : path(file),
        chunk_bytes(options.chunk_bytes),
        flush_period(std::chrono::duration_cast<WallClock::duration>(
            std::chrono::duration<double>(options.flush_wall_s))),
        writer(file, options.compression, options.chunk_bytes, "ros2",
               "vinerow " VINEROW_VERSION_STRING),
        channels(writer, options.compact_poses) {}

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
