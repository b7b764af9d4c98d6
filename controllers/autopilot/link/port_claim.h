#pragma once
/// Ports of a run's autopilots: two that would have the same one are found while the run is built.

#include <string>

#include "engine/mavlink/udp_socket.h"

namespace vinerow::controllers {

enum class Protocol { kUdp, kTcp };

/// While it exists, no other part of the run may have the port. Parts that are built again have
/// theirs. Thread-safe.
class PortClaim {
 public:
  /// @param run  differs for each run in this process  @param who  "rover.autopilot (px4)"
  /// @throws ConfigError "drone.autopilot (px4): TCP port 4560 of 127.0.0.1 is that of
  /// rover.autopilot (px4): give one of them another instance or mavlink_port"
  PortClaim(std::string run, Protocol protocol, mavlink::UdpAddress address, std::string who);
  ~PortClaim();
  PortClaim(const PortClaim&) = delete;
  PortClaim& operator=(const PortClaim&) = delete;

 private:
  std::string place_, who_;
};

}  // namespace vinerow::controllers
