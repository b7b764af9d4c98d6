#pragma once
/// A DDS domain of this process. Internal to this folder.

#include <string>

namespace vinerow::ros2 {

/// Opens a domain, or shares the one that is open; closes it with the last owner.
///
/// If the environment variable CYCLONEDDS_URI is set, it alone configures the domain. Otherwise,
/// unless `network` is true, the domain is bound to the loopback device: it neither receives
/// packets from other hosts nor sends any. Loopback devices usually lack the multicast flag, so
/// discovery is by unicast to the ports of the first 33 participants of this host, repeated every
/// second. Fast DDS and Cyclone with default settings answer to that.
class Domain {
 public:
  /// @param id       0..232, ROS_DOMAIN_ID
  /// @param network  listen and send on the network interface that Cyclone selects
  /// @throws ConfigError "ROS domain id = 300, must be from 0 to 232" | "DDS domain 0 does not
  /// start: <reason of Cyclone>" | "DDS domain 0 is open with another choice of network"
  Domain(int id, bool network);
  ~Domain();
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

  int id() const { return id_; }

 private:
  int id_;
};

/// Configuration of Cyclone DDS for a domain (XML), without the environment.
std::string domain_configuration(bool network);

}  // namespace vinerow::ros2
