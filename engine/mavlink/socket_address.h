#pragma once
/// Addresses as the system's calls take them, for the sockets of this folder.

#include <netinet/in.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "engine/mavlink/udp_socket.h"

namespace vinerow::mavlink {

inline sockaddr_in to_system(UdpAddress address) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_addr.s_addr = htonl(address.host);
  result.sin_port = htons(address.port);
  return result;
}

inline UdpAddress from_system(const sockaddr_in& address) {
  return {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)};
}

/// Why a port cannot be listened at. @param error  errno
inline std::string words_of_bind_failure(int error) {
  return error == EADDRINUSE ? "another program has it" : std::strerror(error);
}

}  // namespace vinerow::mavlink
