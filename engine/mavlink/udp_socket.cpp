#include "engine/mavlink/udp_socket.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "engine/core/error.h"
#include "engine/mavlink/socket_address.h"

namespace vinerow::mavlink {
std::optional<std::uint32_t> parse_ipv4(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1) return std::nullopt;
  return ntohl(address.s_addr);
}

UdpSocket::UdpSocket(UdpAddress own, const std::string& who)
    : descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  if (descriptor_ < 0) {
    throw ConfigError(fmt::format("{}: no UDP socket: {}", who, std::strerror(errno)));
  }
  sockaddr_in address = to_system(own);
  socklen_t size = sizeof address;
  if (::bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      ::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    const std::string reason = words_of_bind_failure(errno);
    ::close(descriptor_);
    throw ConfigError(fmt::format("{}: cannot listen on UDP port {}: {}", who, own.port, reason));
  }
  port_ = from_system(address).port;
}

UdpSocket::~UdpSocket() {
  ::close(descriptor_);
}

std::optional<UdpSocket::Datagram> UdpSocket::receive(std::chrono::milliseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  for (;;) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t count = ::recvfrom(descriptor_, buffer_.data(), buffer_.size(), MSG_DONTWAIT,
                                     reinterpret_cast<sockaddr*>(&from), &size);
    if (count >= 0) {
      const auto length = static_cast<std::size_t>(count);
      return Datagram{std::span<const std::uint8_t>(buffer_).first(std::min(length, kMaxDatagram)),
                      from_system(from), length > kMaxDatagram};
    }
    // Other errors are of an earlier datagram (its receiver is gone) or of a signal.
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    if (left.count() <= 0) return std::nullopt;
    pollfd waits{descriptor_, POLLIN, 0};
    ::poll(&waits, 1, static_cast<int>(left.count()));
  }
}

bool UdpSocket::has_datagram() const {
  pollfd waits{descriptor_, POLLIN, 0};
  return ::poll(&waits, 1, 0) > 0;
}

void UdpSocket::send(std::span<const std::uint8_t> bytes, UdpAddress to) {
  const sockaddr_in address = to_system(to);
  ::sendto(descriptor_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
           reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

}  // namespace vinerow::mavlink
