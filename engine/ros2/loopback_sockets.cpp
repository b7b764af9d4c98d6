#include "engine/ros2/loopback_sockets.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <memory>

#include "engine/core/error.h"

namespace vinerow::ros2 {
namespace {

struct FreeInterfaces {
  void operator()(ifaddrs* interfaces) const { freeifaddrs(interfaces); }
};
using Interfaces = std::unique_ptr<ifaddrs, FreeInterfaces>;

Interfaces list_interfaces() {
  ifaddrs* all = nullptr;
  return Interfaces(getifaddrs(&all) == 0 ? all : nullptr);
}

std::string loopback_device() {
  const Interfaces all = list_interfaces();
  for (const ifaddrs* one = all.get(); one != nullptr; one = one->ifa_next) {
    if ((one->ifa_flags & IFF_LOOPBACK) != 0) return one->ifa_name;
  }
  return "lo";
}

bool is_udp(int descriptor) {
  int type = 0, family = 0;
  socklen_t size = sizeof type;
  return getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &size) == 0 && type == SOCK_DGRAM &&
         getsockopt(descriptor, SOL_SOCKET, SO_DOMAIN, &family, &size) == 0 &&
         (family == AF_INET || family == AF_INET6);
}

std::vector<int> open_udp_sockets() {
  std::vector<int> sockets;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const std::string text = entry.path().filename().string();
    int descriptor = -1;
    std::from_chars(text.data(), text.data() + text.size(), descriptor);
    if (is_udp(descriptor)) sockets.push_back(descriptor);
  }
  std::sort(sockets.begin(), sockets.end());
  return sockets;
}

}  // namespace

DomainSockets::DomainSockets() : before_(open_udp_sockets()) {}

void DomainSockets::bind_to_loopback() const {
  const std::string device = loopback_device();
  for (const int socket : open_udp_sockets()) {
    if (std::binary_search(before_.begin(), before_.end(), socket)) continue;
    // Needs no privilege since Linux 5.7.
    if (setsockopt(socket, SOL_SOCKET, SO_BINDTODEVICE, device.data(),
                   static_cast<socklen_t>(device.size())) != 0) {
      throw ConfigError(fmt::format("cannot bind a DDS socket to the interface {}: {}", device,
                                    std::strerror(errno)));
    }
  }
}

std::vector<std::string> own_addresses(std::size_t max) {
  std::vector<std::string> addresses = {"127.0.0.1"};
  const Interfaces all = list_interfaces();
  for (const ifaddrs* one = all.get(); one != nullptr && addresses.size() < max;
       one = one->ifa_next) {
    constexpr unsigned kNeeded = IFF_UP | IFF_RUNNING;
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET ||
        (one->ifa_flags & kNeeded) != kNeeded || (one->ifa_flags & IFF_LOOPBACK) != 0) {
      continue;
    }
    char text[INET_ADDRSTRLEN] = {};
    const auto& address = *reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    inet_ntop(AF_INET, &address.sin_addr, text, sizeof text);
    addresses.emplace_back(text);
  }
  return addresses;
}

}  // namespace vinerow::ros2
