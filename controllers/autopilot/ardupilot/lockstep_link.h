#pragma once
/// Lock-step with ArduPilot: one answer for each packet of servo outputs.
///
/// ArduPilot sends packet n and waits for the state of the physics, which moves its clock; then it
/// sends packet n + 1. After a second without an answer it repeats the packet. A second answer to
/// one packet would be taken for the next one, and everything would be a step late from then on.

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "controllers/autopilot/ardupilot/servo_packet.h"
#include "engine/mavlink/udp_socket.h"

namespace vinerow::controllers {

class LockstepLink {
 public:
  /// @returns why it makes no sense to wait longer ("ended with status 1"); empty: wait
  using GaveUp = std::function<std::string()>;

  /// @param own  where the autopilot sends its packets  @param who  for errors
  /// @throws ConfigError if the port is taken
  LockstepLink(mavlink::UdpAddress own, const std::string& who) : socket_(own, who) {}

  std::uint16_t port() const { return socket_.port(); }
  /// Bytes of the packet that was returned last.
  std::span<const std::uint8_t> last_packet() const { return last_; }

  /// Waits for the first packet. @returns it, or one sentence without subject about the failure:
  /// "sent nothing for 60 s"
  Result<ServoPacket> wait_for_first(std::chrono::milliseconds limit, const GaveUp& gave_up);

  /// Answers the last packet. @param line  stays valid until the next packet is there
  void answer(std::string_view line);
  /// Waits for the packet after the answer. Wall time decides only when an answer is sent again and
  /// when to give up.
  /// @returns as wait_for_first()
  Result<ServoPacket> wait_for_next(std::chrono::milliseconds limit, const GaveUp& gave_up);

 private:
  using Clock = std::chrono::steady_clock;
  /// @returns the next packet of the peer, or a failure; nullopt if none arrived within `limit`
  std::optional<Result<ServoPacket>> next_packet(std::chrono::milliseconds limit);
  void send();

  mavlink::UdpSocket socket_;
  std::span<const std::uint8_t> last_;  ///< in the socket's buffer
  std::optional<mavlink::UdpAddress> peer_;
  std::uint32_t frame_ = 0;
  std::string_view line_;           ///< the last answer
  Clock::time_point sent_;          ///< when it was sent
  std::optional<Failure> failure_;  ///< of a packet that came before it
};

}  // namespace vinerow::controllers
