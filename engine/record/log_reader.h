#pragma once
/// Reads MCAP logs: whole ones by their index, cut ones (a killed run) by walking the chunks.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/time.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {

struct ChannelInfo {
  int id = 0;
  std::string topic;   ///< "/rover/gps"
  std::string schema;  ///< "sensor_msgs/msg/NavSatFix"
  std::uint64_t messages = 0;
  /// "signal": "rover/gps", and either "vinerow_type": "GnssFix" (what read<T>() takes) or
  /// "exact_of": "/rover/gps" where this channel only holds what the standard type of another
  /// cannot (lists for people may leave it out).
  std::map<std::string, std::string> metadata;
};

struct LogInfo {
  bool complete = false;  ///< false: no (readable) summary, the run was cut off
  Time first;             ///< log time
  Time last;
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::vector<ChannelInfo> channels;               ///< by id
  std::map<std::string, std::string> metadata;     ///< of the "vinerow" record
  std::map<std::string, std::string> attachments;  ///< name -> content

  // What was left out. A whole file's chunks are checked when they are read, so both grow then.
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

  /// Calls back for every message of a topic in the order of the stamps that they were written
  /// with, decoded; equal stamps in the order of the file. Where a topic has an exact channel, that
  /// is read. A topic whose messages lie in another order (a merged log, another writer's) is held
  /// in memory to be sorted, and a warning says so.
  /// @tparam T  a message (engine/api/field.h), also one that a plug-in brought
  /// @throws ConfigError if there is no such topic, or it has another type
  template <class T>
  void read(const std::string& topic, const std::function<void(Time, const T&)>& callback) const {
    using Mapping = RosMapping<T>;
    T value;
    read_messages(topic, {T::kType, Mapping::type(), Mapping::exact_type()},
                  [&](CdrReader& in, const FrameNames& frames, Time stamp) {
                    if (!Mapping::read(in, frames, value)) return false;
                    callback(stamp, value);
                    return true;
                  });
  }

 private:
  /// What a message is called: by us, and in the log.
  struct MessageNames {
    std::string message;
    std::string type;
    std::string exact_type;  ///< "": none
  };
  /// @param take  false where the bytes hold no such message
  void read_messages(const std::string& topic, const MessageNames& names,
                     const std::function<bool(CdrReader&, const FrameNames&, Time)>& take) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::record
