#pragma once
/// A part that can find that its vehicle cannot do its task any more: a follower has lost its path,
/// a landing ends far from where it should.

#include <string_view>

namespace vinerow {

/// What a Guidance or a Controller is besides where it can fail. The kernel asks after every
/// physics step; a failure ends or fails the run as a crash does (`on_crash`), and people are told
/// the reason.
class MayFail {
 public:
  virtual ~MayFail() = default;
  /// Why it cannot go on, "lost its path: 5.1 m from it"; empty while it can. Once told it stays
  /// until the part gets another task.
  virtual std::string_view failure() const = 0;
};

}  // namespace vinerow
