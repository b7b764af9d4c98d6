#pragma once
/// Reads MCAP logs: whole ones by their index, cut ones (a killed run) by walking the chunks.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/messages.h"
#include "engine/core/time.h"

namespace vinerow::record {

struct ChannelInfo {
  int id = 0;
  std::string topic;         ///< "/rover/gps"
  std::string schema;        ///< "sensor_msgs/msg/NavSatFix"
  std::uint64_t messages = 0;
  std::map<std::string, std::string> metadata;
};

struct LogInfo {
  bool complete = false;     ///< false: no footer, the run was cut off
  Time first;
  Time last;
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::vector<ChannelInfo> channels;
  std::map<std::string, std::string> metadata;     ///< of the "vinerow" record
  std::map<std::string, std::string> attachments;  ///< name -> content
};

class LogReader {
 public:
  /// @throws ConfigError "x.mcap: not an MCAP file" | "x.mcap: cannot be read"
  explicit LogReader(const std::filesystem::path& file);
  ~LogReader();

  const LogInfo& info() const;

  /// Calls back for every message of a topic in log order, decoded. @throws ConfigError if the topic has another type
  template <class T>
  void read(const std::string& topic, const std::function<void(Time, const T&)>& callback) const;

  /// Raw messages of every topic in log order.
  void read_raw(const std::function<void(Time, const ChannelInfo&, const std::vector<std::uint8_t>&)>& callback) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::record
