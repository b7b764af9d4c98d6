#pragma once
/// Keeps a DDS domain off the network. Internal to this folder.

#include <string>
#include <vector>

namespace vinerow::ros2 {

/// The sockets that Cyclone opens while it starts a domain. It binds receiving sockets to all
/// addresses (0.0.0.0) whatever its interfaces are, so that packets from the network would reach
/// the simulator.
class DomainSockets {
 public:
  /// Remembers the UDP sockets that are open before the start.
  DomainSockets();
  /// Binds the UDP sockets opened since to the loopback device: packets between processes of this
  /// host pass, to any of its addresses, and no other packets do.
  /// @throws ConfigError "cannot bind a DDS socket to the interface lo: <reason>"
  void bind_to_loopback() const;

 private:
  std::vector<int> before_;
};

/// IPv4 addresses of this host's interfaces, 127.0.0.1 first, at most `max`.
std::vector<std::string> own_addresses(std::size_t max);

}  // namespace vinerow::ros2
