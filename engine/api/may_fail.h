#pragma once
/// Interface of parts that can detect that their vehicle can no longer do its task: a follower has
/// lost its path, a landing ends far from its target.

#include <string_view>

namespace vinerow {

/// Additional base class of a Guidance or Controller that can fail. The kernel queries failure()
/// after every physics step. A failure ends or fails the run as a crash does (`on_crash`), and the
/// reason is reported as an event.
class MayFail {
 public:
  virtual ~MayFail() = default;
  /// Reason of the failure, "lost its path: 5.1 m from it"; empty without a failure. Once set, it
  /// stays until the part gets another task.
  virtual std::string_view failure() const = 0;
};

}  // namespace vinerow
