#pragma once
/// Reader of MCAP logs: complete files by their index, truncated ones (of a killed run) by scanning
/// the chunks.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/time.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {

struct ChannelInfo {
  int id = 0;
  std::string topic;   ///< "/rover/gps"
  std::string schema;  ///< "sensor_msgs/msg/NavSatFix"
  std::uint64_t messages = 0;
  /// "signal": "rover/gps", and one of two keys. "vinerow_type": "GnssFix" is the type for
  /// read<T>(). "exact_of": "/rover/gps" marks a channel that holds the exact values of another
  /// channel, whose standard type cannot; lists for users may omit it.
  std::map<std::string, std::string> metadata;
};

struct LogInfo {
  bool complete = false;  ///< false: no readable summary, the run was interrupted
  Time first;             ///< log time
  Time last;
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::vector<ChannelInfo> channels;            ///< by id
  std::map<std::string, std::string> metadata;  ///< of the "vinerow" record
  /// "digest", "end" ("over" or "broken off") and "end_ns"; empty if the run was killed.
  std::map<std::string, std::string> result;
  std::map<std::string, std::string> attachments;  ///< name -> content

  // Skipped data. Chunks of a complete file are checked when they are read; both members can grow
  // then.
  std::uint64_t damaged = 0;          ///< chunks, records and messages
  std::vector<std::string> warnings;  ///< one sentence for each
};

class LogReader {
 public:
  /// @throws ConfigError "x.mcap: not an MCAP file" | "x.mcap: cannot be read: ..." | "x.mcap: an
  /// MCAP file that is cut off or damaged inside its first record"
  explicit LogReader(const std::filesystem::path& file);
  ~LogReader();

  const LogInfo& info() const;
  bool has_topic(const std::string& topic) const;

  /// Decodes every message of a topic and passes it to the callback, in the order of the stamps;
  /// messages with equal stamps keep the file's order. If a topic has an exact channel, that
  /// channel is read. If the messages are in another order in the file (a merged log, another
  /// writer), they are sorted in memory, with a warning. Decompresses the whole log: LogPass reads
  /// several topics at once.
  /// @tparam T  a message (engine/api/field.h), also one of a plug-in
  /// @throws ConfigError if there is no such topic, or it has another type
  template <class T>
  void read(const std::string& topic, std::function<void(Time, const T&)> callback) const;

 private:
  friend class LogPass;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Topics that are read together.
class LogPass {
 public:
  /// @param log  outlives this object
  explicit LogPass(const LogReader& log) : log_(log) {}

  /// run() will read the topic as LogReader::read() does.
  /// @throws ConfigError  as LogReader::read()
  template <class T>
  void read(const std::string& topic, std::function<void(Time, const T&)> callback) {
    using Mapping = RosMapping<T>;
    add(topic, {T::kType, Mapping::type(), Mapping::exact_type()},
        [callback = std::move(callback), value = T()](CdrReader& in, const FrameNames& frames,
                                                      Time stamp) mutable {
          if (!Mapping::read(in, frames, value)) return false;
          callback(stamp, value);
          return true;
        });
  }

  /// Calls back for the messages of all topics, each topic's in the order of its stamps.
  void run();

 private:
  /// Names of a message in this project and in the log.
  struct MessageNames {
    std::string message;
    std::string type;
    std::string exact_type;  ///< "": none
  };
  /// Returns false if the bytes are not such a message.
  using Take = std::function<bool(CdrReader&, const FrameNames&, Time)>;
  struct Topic {
    std::uint16_t channel = 0;
    FrameNames frames;
    Take take;
  };
  void add(const std::string& topic, const MessageNames& names, Take take);

  friend struct LogReader::Impl;
  const LogReader& log_;
  std::vector<Topic> topics_;
};

template <class T>
void LogReader::read(const std::string& topic, std::function<void(Time, const T&)> callback) const {
  LogPass pass(*this);
  pass.read<T>(topic, std::move(callback));
  pass.run();
}

}  // namespace vinerow::record
