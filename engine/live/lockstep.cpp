#include "engine/live/lockstep.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace vinerow::live {
namespace {

constexpr std::size_t kMostAhead = 1000;  // commands that a peer may send in advance

}  // namespace

Lockstep::Lockstep(scenario::LockstepConfig options) : options_(std::move(options)) {
  restart();
}

void Lockstep::restart() {
  due_ = Time{options_.period.ns};
  commands_.clear();
  waiting_since_.reset();
  is_suspended_ = false;
}

std::string Lockstep::add(PeerCommand command) {
  const Time stamp = command.command.stamp;
  const auto words = [&](const std::string& reason) {
    return fmt::format("the command for '{}' stamped {:.9g} s {}", options_.signal, stamp.s(),
                       reason);
  };
  if (stamp < due_) {
    return words(fmt::format("comes too late: the next one is due at {:.9g} s", due_.s()));
  }
  if (stamp.ns % options_.period.ns != 0) {
    return words(fmt::format("is not at a multiple of {:g} s", options_.period.s()));
  }
  if (commands_.size() >= kMostAhead) {
    return words(fmt::format("is one of more than {} in advance", kMostAhead));
  }
  if (!commands_.emplace(stamp.ns, std::move(command)).second) return words("is a second one");
  is_suspended_ = false;
  return "";
}

std::optional<PeerCommand> Lockstep::take() {
  const auto first = commands_.find(due_.ns);
  if (first == commands_.end()) return std::nullopt;
  PeerCommand command = std::move(first->second);
  commands_.erase(first);
  due_ = due_ + options_.period;
  waiting_since_.reset();
  return command;
}

bool Lockstep::has_timed_out(Clock::time_point now) {
  if (!waiting_since_) waiting_since_ = now;
  return std::chrono::duration<double>(now - *waiting_since_).count() >= options_.timeout_s;
}

void Lockstep::suspend(Time now) {
  is_suspended_ = true;
  waiting_since_.reset();
  pass(now);
}

void Lockstep::pass(Time now) {
  // The first multiple of the period that is not before `now`.
  const std::int64_t periods = (now.ns + options_.period.ns - 1) / options_.period.ns;
  due_ = Time{std::max<std::int64_t>(periods, 1) * options_.period.ns};
  commands_.erase(commands_.begin(), commands_.lower_bound(due_.ns));
}

}  // namespace vinerow::live
