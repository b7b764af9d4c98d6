#pragma once
/// Datagrams to and from a program on this host.

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace vinerow::mavlink {

/// IPv4 address and port.
struct UdpAddress {
  std::uint32_t host = 0;  ///< in host order
  std::uint16_t port = 0;
  friend bool operator==(const UdpAddress&, const UdpAddress&) = default;
};

/// @returns the address of "127.0.0.1"; nullopt if the text is not four numbers with dots
std::optional<std::uint32_t> parse_ipv4(const std::string& text);

class UdpSocket {
 public:
  /// Largest datagram that is read whole, bytes.
  static constexpr std::size_t kMaxDatagram = 2048;

  struct Datagram {
    std::span<const std::uint8_t> bytes;  ///< valid until the next call
    UdpAddress from;
    bool is_cut = false;  ///< it was longer than kMaxDatagram
  };

  /// @param own  address to listen at; port 0: any free one
  /// @param who  "rover.autopilot (ardupilot)", for errors
  /// @throws ConfigError if the port is taken
  UdpSocket(UdpAddress own, const std::string& who);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;

  std::uint16_t port() const { return port_; }
  /// Waits at most `limit` for a datagram; 0: takes only what has arrived.
  std::optional<Datagram> receive(std::chrono::milliseconds limit);
  /// True if a datagram has arrived that was not taken yet.
  bool has_datagram() const;
  /// A datagram that cannot be sent now is lost, as on any network.
  void send(std::span<const std::uint8_t> bytes, UdpAddress to);

 private:
  int descriptor_ = -1;
  std::uint16_t port_ = 0;
  std::array<std::uint8_t, kMaxDatagram + 1> buffer_{};
};

}  // namespace vinerow::mavlink
