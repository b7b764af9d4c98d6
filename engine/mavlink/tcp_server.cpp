#include "engine/mavlink/tcp_server.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "engine/core/error.h"
#include "engine/mavlink/socket_address.h"

namespace vinerow::mavlink {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// @returns true if the descriptor is ready before the limit has passed
bool wait_for(int descriptor, short events, Clock::time_point end) {
  for (;;) {
    const auto left = std::chrono::ceil<milliseconds>(end - Clock::now());
    pollfd waits{descriptor, events, 0};
    const int ready =
        ::poll(&waits, 1, static_cast<int>(std::max<milliseconds::rep>(left.count(), 0)));
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

void set_flag(int descriptor, int level, int name) {
  const int yes = 1;
  ::setsockopt(descriptor, level, name, &yes, sizeof yes);
}

}  // namespace

TcpServer::TcpServer(UdpAddress own, const std::string& who)
    : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (listener_ < 0) {
    throw ConfigError(fmt::format("{}: no TCP socket: {}", who, std::strerror(errno)));
  }
  // A run that has just ended leaves its port in a state that would refuse the next one.
  set_flag(listener_, SOL_SOCKET, SO_REUSEADDR);
  sockaddr_in address = to_system(own);
  socklen_t size = sizeof address;
  if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      ::listen(listener_, 1) != 0 ||
      ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    const std::string reason = words_of_bind_failure(errno);
    ::close(listener_);
    throw ConfigError(fmt::format("{}: cannot listen on TCP port {}: {}", who, own.port, reason));
  }
  port_ = from_system(address).port;
}

TcpServer::~TcpServer() {
  if (peer_ >= 0) ::close(peer_);
  ::close(listener_);
}

bool TcpServer::accept(milliseconds limit) {
  if (peer_ >= 0) return true;
  if (!wait_for(listener_, POLLIN, Clock::now() + limit)) return false;
  peer_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (peer_ < 0) return false;
  // A step is one small message each way, which must not wait for more.
  set_flag(peer_, IPPROTO_TCP, TCP_NODELAY);
  return true;
}

std::span<const std::uint8_t> TcpServer::receive(milliseconds limit) {
  if (peer_ < 0 || is_closed_) return {};
  const auto end = Clock::now() + limit;
  for (;;) {
    const ssize_t count = ::recv(peer_, buffer_.data(), buffer_.size(), 0);
    if (count > 0)
      return std::span<const std::uint8_t>(buffer_).first(static_cast<std::size_t>(count));
    const bool has_none = count < 0 && (errno == EAGAIN || errno == EINTR);
    if (!has_none) {
      is_closed_ = true;
      return {};
    }
    if (!wait_for(peer_, POLLIN, end)) return {};
  }
}

bool TcpServer::send(std::span<const std::uint8_t> bytes, milliseconds limit) {
  const auto end = Clock::now() + limit;
  while (peer_ >= 0 && !bytes.empty()) {
    const ssize_t count = ::send(peer_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    } else if (errno != EAGAIN && errno != EINTR) {
      is_closed_ = true;
      return false;
    } else if (!wait_for(peer_, POLLOUT, end)) {
      return false;
    }
  }
  return bytes.empty();
}

}  // namespace vinerow::mavlink
