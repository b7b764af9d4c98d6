#pragma once
/// Recording of the datagrams between the simulator and an autopilot: a pcap file, which Wireshark
/// and tcpdump read. Its times are those of the simulation, so equal runs give equal files.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/time.h"
#include "engine/mavlink/udp_socket.h"

namespace vinerow::controllers {

struct RecordedDatagram {
  Time time;
  mavlink::UdpAddress from, to;
  std::vector<std::uint8_t> bytes;
};

class DatagramRecorder {
 public:
  /// @throws WriteError
  explicit DatagramRecorder(const std::filesystem::path& file);
  /// @throws WriteError
  void add(Time time, mavlink::UdpAddress from, mavlink::UdpAddress to,
           std::span<const std::uint8_t> bytes);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void write(std::span<const std::uint8_t> bytes);

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Reads what DatagramRecorder wrote. Packets that are not IPv4 with UDP are skipped.
class DatagramReader {
 public:
  /// @param who  for errors  @throws ConfigError if the file is no pcap file
  DatagramReader(const std::filesystem::path& file, std::string who);
  /// @returns the next datagram; nullopt at the end, also where a killed run cut the last one
  std::optional<RecordedDatagram> next();

 private:
  bool read(std::span<std::uint8_t> bytes);
  /// @throws ConfigError
  [[noreturn]] void refuse(const std::string& fault) const;

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_, who_;
  std::unique_ptr<std::FILE, Close> file_;
  bool has_nanoseconds_ = true;
  std::size_t link_header_ = 0;  ///< bytes before the IP header
};

}  // namespace vinerow::controllers
