#pragma once
/// Writes signals of a run into an MCAP file with CDR-encoded ROS 2 messages (README.md: which
/// signal becomes which message).
///
/// The messages in a log depend on the run alone: wall time decides only when a chunk is closed and
/// handed to the system. Cost: about a microsecond a message; after the first chunk nothing is
/// allocated but what a chunk's entry in the closing index needs.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/signal.h"
#include "engine/record/scene_message.h"

namespace vinerow::record {

struct RecorderOptions {
  std::string compression = "zstd";      ///< zstd | lz4 | none
  std::size_t chunk_bytes = 768 * 1024;  ///< a chunk is closed when this much is in it ...
  double flush_wall_s = 1.0;  ///< ... or this much wall time has passed, and is flushed to the file
  /// Link and sensor poses are stored relative to "<vehicle>/truth" and rounded to 1 nm and 2 nrad;
  /// false: in the world and to the last bit, which makes a log a fifth larger.
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

  /// Adds a channel for a signal, and a second one "<topic>/exact" where the ROS 2 type cannot hold
  /// the whole value. Topic is "/" + signal name. Order of calls = channel ids.
  /// @param min_period  samples whose stamp is closer than this to the last recorded one's are left
  /// out; 0 = every one
  /// @param frame  of messages that name the signal's own; empty: the signal's name
  /// @param exact_alone  where there are two messages, only the one that holds the whole value, as
  /// "<topic>"
  void add_signal(const SignalBase& signal, Duration min_period, const std::string& frame = {},
                  bool exact_alone = false);

  /// Stores where frames stand in others as "/tf_static", at time 0.
  void add_static_transforms(const std::vector<StaticTransform>& transforms);
  /// Stores solid things to be drawn as "/run/scene", at time 0.
  void add_scene(const std::vector<SceneEntity>& entities);

  /// Stores every added signal that was written since the last call. Log time is `now`, publish
  /// time the signal's stamp. Never logs; throws SimulationError when the file cannot be written
  /// (disk full), once: after that it does nothing.
  void record(Time now);

  /// Embeds a whole file (resolved scenario, summary) as an MCAP attachment.
  void add_attachment(const std::string& name, const std::string& media_type,
                      const std::string& content);

  /// Writes summary and footer. Nothing may be added afterwards. @throws SimulationError when the
  /// file cannot be written and record() has not said so already
  void finish();

  /// In the file so far, without the open chunk.
  std::uint64_t bytes_written() const;
  /// On all channels, "/exact" ones included.
  std::uint64_t message_count() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::record
