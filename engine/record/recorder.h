#pragma once
/// Recorder of a run's signals in an MCAP file with CDR-encoded ROS 2 messages (README.md has the
/// table of signals and messages).
///
/// The messages in a log depend only on the run; wall time affects only when a chunk is closed and
/// handed to the system. Cost: about 1 us per message. After the first chunk, only the chunk's
/// entry in the final index is allocated.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "engine/record/signal_channels.h"

namespace vinerow::record {

struct RecorderOptions {
  std::string compression = "zstd";      ///< zstd | lz4 | none
  std::size_t chunk_bytes = 768 * 1024;  ///< a chunk is closed at this size ...
  double flush_wall_s = 1.0;             ///< ... or after this wall time, and flushed to the file
  /// true: link and sensor poses are stored relative to "<vehicle>/truth", rounded to 1 nm and 2
  /// nrad. false: they are stored exactly in W, which makes a log 20 % larger.
  bool compact_poses = true;
};

class Recorder {
 public:
  /// @param metadata  stored as MCAP metadata record "vinerow" (scenario, seed, versions)
  /// @throws ConfigError when the file cannot be created or the compression is unknown
  Recorder(const std::filesystem::path& file, const RecorderOptions& options,
           const std::map<std::string, std::string>& metadata);
  /// Closes the file with summary and footer if finish() was not called.
  ~Recorder();

  /// Channels of the log, before the first record().
  SignalChannels& channels();

  /// Stores every added signal that was written since the last call. Log time is `now`, publish
  /// time is the signal's stamp. @throws SimulationError once if the file cannot be written (disk
  /// full); later calls do nothing
  void record(Time now);

  /// Embeds a whole file (resolved scenario, summary) as an MCAP attachment.
  void add_attachment(const std::string& name, const std::string& media_type,
                      const std::string& content);

  /// Adds the MCAP metadata record "vinerow_result".
  void add_result(const std::map<std::string, std::string>& values);

  /// Writes summary and footer. Nothing may be added afterwards. @throws SimulationError if the
  /// file cannot be written and record() has not thrown already
  void finish();

  /// Bytes in the file so far, without the open chunk.
  std::uint64_t bytes_written() const;
  /// Messages on all channels, including "/exact".
  std::uint64_t message_count() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::record
