#pragma once
/// Subscription of one topic (Node::create_subscription()).

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "engine/ros2/guid.h"

namespace vinerow::ros2 {

class Participant;

struct Message {
  std::vector<std::uint8_t> cdr;    ///< with encapsulation header, may end with up to 3 bytes more
  Guid writer{};                    ///< zero if the writer left before its first message was taken
  std::int64_t source_time_ns = 0;  ///< the writer's wall clock, since 1970
};

class Subscription {
 public:
  ~Subscription();
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;

  /// Takes the oldest message. Memory of `out` is used again.
  /// @returns false if there is no message; `out` is unchanged then
  bool take(Message& out);

  /// Publishers that match, of any process.
  int publisher_count() const;
  Guid guid() const;

 private:
  friend class Node;
  Subscription(std::shared_ptr<Participant> participant, std::int32_t reader);

  Guid writer_of(std::uint64_t handle);

  std::shared_ptr<Participant> participant_;
  std::int32_t reader_;
  std::map<std::uint64_t, Guid> writers_;  ///< by Cyclone's handle; a lookup walks all matches
};

}  // namespace vinerow::ros2
