#pragma once
/// Publisher of one topic (Node::create_publisher()).

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

#include "engine/ros2/guid.h"

struct ddsi_sertype;  // of Cyclone DDS

namespace vinerow::ros2 {

class Participant;

class Publisher {
 public:
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  /// Sends a message. Never waits for a reader: with "keep last" a slow or stopped reader loses
  /// the oldest messages. The socket calls are made here, one for each reading process and 64 KiB
  /// (9 µs for an Imu to one process, tests/engine/ros2/judge_test.cpp).
  /// @param cdr  a whole message with encapsulation header, at least 4 bytes; copied
  /// @returns false if it was dropped: too short, no memory, or the writer refused it
  bool publish(std::span<const std::uint8_t> cdr);

  /// Messages for which publish() returned false.
  std::uint64_t dropped() const { return dropped_; }
  /// Subscriptions that match, of any process.
  int subscriber_count() const;
  Guid guid() const;

 private:
  friend class Node;
  Publisher(std::shared_ptr<Participant> participant, std::int32_t writer,
            const ddsi_sertype* type);

  std::shared_ptr<Participant> participant_;
  std::int32_t writer_;
  const ddsi_sertype* type_;  ///< held by the writer
  std::atomic<std::uint64_t> dropped_ = 0;
};

}  // namespace vinerow::ros2
