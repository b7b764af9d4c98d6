#pragma once
/// Writes signals of a run into an MCAP file with CDR-encoded ROS 2 messages.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "engine/api/signal.h"

namespace vinerow::record {

struct RecorderOptions {
  std::string compression = "zstd";      ///< zstd | lz4 | none
  std::size_t chunk_bytes = 768 * 1024;  ///< a chunk is closed when this much is in it ...
  double flush_wall_s = 1.0;             ///< ... or this much wall time has passed, and is flushed to the file
};

class Recorder {
 public:
  /// @param metadata  stored as MCAP metadata record "vinerow" (scenario, seed, versions)
  /// @throws ConfigError when the file cannot be created
  Recorder(const std::filesystem::path& file, const RecorderOptions& options,
           const std::map<std::string, std::string>& metadata);
  /// Closes the file with summary and footer if finish() was not called.
  ~Recorder();

  /// Adds a channel for a signal. Topic is "/" + signal name. Order of calls = channel ids.
  /// @param min_period  samples closer than this to the last recorded one are left out; 0 = every one
  void add_signal(const SignalBase& signal, Duration min_period);

  /// Stores every added signal that was written since the last call.
  void record(Time now);

  /// Embeds a whole file (resolved scenario, summary) as an MCAP attachment.
  void add_attachment(const std::string& name, const std::string& media_type, const std::string& content);

  void finish();
  std::uint64_t bytes_written() const;
  std::uint64_t message_count() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::record
