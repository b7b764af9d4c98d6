#pragma once
/// A stream of bytes to and from one program on this host, which connects to us.

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>

#include "engine/mavlink/udp_socket.h"

namespace vinerow::mavlink {

class TcpServer {
 public:
  /// @param own  address to listen at; port 0: any free one
  /// @param who  "drone.autopilot (px4)", for errors
  /// @throws ConfigError if the port is taken
  TcpServer(UdpAddress own, const std::string& who);
  ~TcpServer();
  TcpServer(const TcpServer&) = delete;

  std::uint16_t port() const { return port_; }
  /// Waits at most `limit` for a peer. @returns true if there is one. Only the first is served; the
  /// port stays taken.
  bool accept(std::chrono::milliseconds limit);
  /// Waits at most `limit` for bytes; 0: takes only what has arrived.
  /// @returns them, valid until the next call; empty: none came, or the peer has gone
  std::span<const std::uint8_t> receive(std::chrono::milliseconds limit);
  /// True once the peer has closed its connection.
  bool is_closed() const { return is_closed_; }
  /// Waits at most `limit` until all bytes are handed over. @returns false if they were not
  bool send(std::span<const std::uint8_t> bytes, std::chrono::milliseconds limit);

 private:
  int listener_ = -1, peer_ = -1;
  std::uint16_t port_ = 0;
  bool is_closed_ = false;
  std::array<std::uint8_t, 4096> buffer_{};
};

}  // namespace vinerow::mavlink
