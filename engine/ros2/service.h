#pragma once
/// Server of one service (Node::create_service()).
///
/// Source: rmw_cyclonedds_cpp: request and reply begin with 8 bytes of the client's identity and
/// an 8-byte sequence number. rmw_fastrtps_cpp does it in another way, so its clients find the
/// service, but their calls do not work: start them with RMW_IMPLEMENTATION=rmw_cyclonedds_cpp.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/ros2/guid.h"

struct ddsi_sertype;  // of Cyclone DDS

namespace vinerow::ros2 {

class Participant;

struct Request {
  std::vector<std::uint8_t> cdr;  ///< the request message with encapsulation header
  std::array<std::uint8_t, 16>
      header{};              ///< client and sequence number, in the client's byte order
  std::uint64_t writer = 0;  ///< Cyclone's handle of the client's writer
};

class Service {
 public:
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Takes the oldest request. Requests too short for their header are skipped.
  /// @returns false if there is no request
  bool take(Request& out);

  /// Answers a request. Waits up to 100 ms if the client's reader is not discovered yet, so that
  /// the first call of a new client does not lose its answer.
  /// @param cdr  the response message with encapsulation header
  /// @returns false if the client is gone, its reader did not appear, or `cdr` is too short
  bool reply(const Request& request, std::span<const std::uint8_t> cdr);

 private:
  friend class Node;
  Service(std::shared_ptr<Participant> participant, std::int32_t reader, std::int32_t writer,
          const ddsi_sertype* response_type);

  bool client_reads(std::uint64_t request_writer) const;

  std::shared_ptr<Participant> participant_;
  std::int32_t reader_, writer_;
  const ddsi_sertype* response_type_;  ///< held by the writer
};

}  // namespace vinerow::ros2
