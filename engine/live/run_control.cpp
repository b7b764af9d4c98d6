#include "engine/live/run_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/sim/session.h"
#include "engine/sim/simulation.h"

namespace vinerow::live {
namespace {

using std::chrono::milliseconds;

// The run looks for an interrupt of the user this often.
constexpr milliseconds kLongestWait{100};
// A silent peer keeps a signal for so long.
constexpr milliseconds kOwnerSilence{1000};
constexpr double kMaxSpeed = 1e6;
// More steps than a slice has, and few enough for their duration in nanoseconds.
constexpr std::uint64_t kManySteps = 1'000'000;

/// No instant: the run calls again.
run::RunDriver::Next none_yet(const Session& session) {
  return {session.now() - Duration{1}};
}

}  // namespace

RunControl::RunControl(ControlOptions options, Notify notify)
    : notify_(std::move(notify)), paused_(options.paused) {
  if (options.lockstep) lockstep_.emplace(*std::move(options.lockstep));
  pacer_.set_speed(options.speed);
  snapshot_.speed = options.speed;
}

RunSnapshot RunControl::snapshot() const {
  const Lock lock(mutex_);
  return snapshot_;
}

void RunControl::poke() {
  poked_ = true;
  wake_.notify_one();
}

void RunControl::pause() {
  const Lock lock(mutex_);
  paused_ = true;
  if (snapshot_.state == RunState::kPlaying) snapshot_.state = RunState::kPaused;
  poke();
}

void RunControl::resume() {
  const Lock lock(mutex_);
  paused_ = false;
  if (snapshot_.state == RunState::kPaused) snapshot_.state = RunState::kPlaying;
  pacer_.rebase();
  poke();
}

std::string RunControl::set_speed(double speed) {
  if (!(speed >= 0.0 && speed <= kMaxSpeed)) {
    return fmt::format("speed = {:g}, must be within [0, {:g}]; 0 = as fast as possible", speed,
                       kMaxSpeed);
  }
  const Lock lock(mutex_);
  pacer_.set_speed(speed);
  snapshot_.speed = speed;
  poke();
  return "";
}

void RunControl::step(std::uint64_t steps, Answer answer) {
  std::string refusal;
  {
    const Lock lock(mutex_);
    if (snapshot_.state == RunState::kOver) {
      refusal = "the run is over";
    } else if (!paused_) {
      refusal = "the run is not paused: pause it before stepping";
    } else if (steps_left_ > 0) {
      refusal = fmt::format("{} steps of an earlier request are still to be made", steps_left_);
    } else if (steps > 0) {
      steps_left_ = steps;
      step_answer_ = std::move(answer);
      poke();
      return;
    }
  }
  answer(refusal);
}

void RunControl::reset(std::optional<std::uint64_t> seed, Answer answer) {
  {
    const Lock lock(mutex_);
    if (snapshot_.state != RunState::kOver) {
      reset_seed_ = seed.value_or(snapshot_.seed);
      reset_answers_.push_back(std::move(answer));
      poke();
      return;
    }
  }
  answer("the run is over, and its files are written");
}

void RunControl::hold_start() {
  const Lock lock(mutex_);
  is_held_ = true;
}

void RunControl::release_start() {
  const Lock lock(mutex_);
  is_held_ = false;
  poke();
}

void RunControl::stop(const std::string& reason) {
  const Lock lock(mutex_);
  stop_reason_ = reason;
  poke();
}

std::string RunControl::submit(PeerCommand command) {
  const Lock lock(mutex_);
  const std::string signal = command.command.value->name();
  if (snapshot_.state == RunState::kStarting) return "the run has not begun";
  if (snapshot_.state == RunState::kOver) return "the run is over";
  if (std::ranges::find(signals_, signal) == signals_.end()) {
    if (signals_.empty()) return "no part of this run takes commands from outside";
    return fmt::format("no part takes commands from outside as '{}'{} (there are: {})", signal,
                       did_you_mean(signal, signals_), join(signals_));
  }
  if (command.command.value->has_nan()) {
    return fmt::format("the command for '{}' contains NaN", signal);
  }
  const Clock::time_point now = Clock::now();
  Owner& owner = owners_.try_emplace(signal, Owner{command.peer, now}).first->second;
  if (owner.peer != command.peer) {
    if (now - owner.last < kOwnerSilence) {
      return fmt::format(
          "'{}' is commanded by {}; another peer can take over {:g} s after its last "
          "command",
          signal, owner.peer, std::chrono::duration<double>(kOwnerSilence).count());
    }
    owner.peer = command.peer;
  }
  owner.last = now;
  if (lockstep_ && lockstep_->options().signal == signal) {
    const std::string refusal = lockstep_->add(std::move(command));
    if (refusal.empty()) poke();
    return refusal;
  }
  waiting_.insert_or_assign(signal, std::move(command));
  return "";
}

void RunControl::release(const std::string& peer) {
  const Lock lock(mutex_);
  std::erase_if(owners_, [&](const auto& owner) { return owner.second.peer == peer; });
}

void RunControl::begin(Session& session) {
  session.simulation().prepare();
  std::vector<Answer> answers;
  {
    const Lock lock(mutex_);
    signals_ = session.simulation().outside_signals();
    if (lockstep_) lockstep_->restart();
    waiting_.clear();
    pacer_.rebase();
    if (snapshot_.state != RunState::kStarting) ++snapshot_.restarts;
    snapshot_.seed = session.seed();
    note_progress(session);
    answers = std::exchange(reset_answers_, {});
  }
  for (const Answer& answer : answers) answer("");
}

void RunControl::note_progress(const Session& session) {
  const std::uint64_t made = session.steps() - std::min(snapshot_.steps, session.steps());
  snapshot_.now = session.now();
  snapshot_.steps = session.steps();
  steps_left_ -= std::min(made, steps_left_);
  snapshot_.state = paused_ ? RunState::kPaused : RunState::kPlaying;
  snapshot_.real_time_factor = pacer_.measure(session.now(), Clock::now());
}

bool RunControl::wait(Lock& lock, Clock::duration longest) {
  const auto limit = std::min<Clock::duration>(longest, kLongestWait);
  wake_.wait_for(lock, limit, [this] { return poked_; });
  return std::exchange(poked_, false);
}

run::RunDriver::Next RunControl::next(Session& session, Time slice_end) {
  Lock lock(mutex_);
  note_progress(session);
  if (!stop_reason_.empty()) throw SimulationError("run", session.now(), stop_reason_);
  if (reset_seed_) {
    steps_left_ = 0;
    const Answer stepping = std::exchange(step_answer_, nullptr);
    const std::uint64_t seed = *std::exchange(reset_seed_, std::nullopt);
    lock.unlock();
    if (stepping) stepping("the run was reset");
    return {session.now(), seed};
  }
  if (steps_left_ == 0 && step_answer_) {
    const Answer answer = std::exchange(step_answer_, nullptr);
    lock.unlock();
    answer("");
    return none_yet(session);
  }
  if (paused_ && steps_left_ == 0) {
    wait(lock, kLongestWait);
    pacer_.rebase();
    return none_yet(session);
  }

  if (is_held_) {
    wait_for_start(lock, session);
    return none_yet(session);
  }

  const Pacer::Plan plan = pacer_.plan(session.now(), Clock::now(), slice_end - session.now());
  const std::string lag = pacer_.take_lag();
  if (plan.wait.count() > 0) {
    wait(lock, plan.wait);
    return none_yet(session);
  }
  Time until = session.now() + plan.slice;
  if (paused_) {
    const std::uint64_t more = std::min(steps_left_ - 1, kManySteps);
    until = std::min(until, session.now() + session.step() * static_cast<std::int64_t>(more));
  }
  std::vector<PeerCommand> commands;
  const bool may_go = !lockstep_ || await_lockstep(lock, session, until, commands);
  if (may_go) {
    for (auto& [signal, command] : waiting_) {
      command.command.stamp = session.now();
      commands.push_back(std::move(command));
    }
    waiting_.clear();
  }
  lock.unlock();
  if (!lag.empty()) notify_(Level::kWarning, lag);
  give(session, std::move(commands));
  return may_go ? Next{until} : none_yet(session);
}

void RunControl::wait_for_start(Lock& lock, const Session& session) {
  const Clock::time_point now = Clock::now();
  if (!held_since_) held_since_ = now;
  const double waited_s = std::chrono::duration<double>(now - *held_since_).count();
  if (lockstep_ && waited_s > lockstep_->options().timeout_s) {
    throw SimulationError("lockstep", session.now(),
                          fmt::format("no peer for '{}' has appeared for {:g} s",
                                      lockstep_->options().signal, lockstep_->options().timeout_s));
  }
  wait(lock, kLongestWait);
  pacer_.rebase();
}

bool RunControl::await_lockstep(Lock& lock, Session& session, Time& until,
                                std::vector<PeerCommand>& commands) {
  Lockstep& lockstep = *lockstep_;
  // After a suspension, instants that needed a command have passed without one.
  if (lockstep.is_suspended() || lockstep.due() < session.now()) lockstep.pass(session.now());
  while (session.now() >= lockstep.due()) {
    if (std::optional<PeerCommand> command = lockstep.take()) {
      commands.push_back(*std::move(command));
      break;
    }
    if (lockstep.is_suspended()) break;
    if (lockstep.has_timed_out(Clock::now())) {
      const std::string& signal = lockstep.options().signal;
      const std::string sentence =
          fmt::format("no command for '{}' stamped {:.9g} s has come for {:g} s{}", signal,
                      lockstep.due().s(), lockstep.options().timeout_s, describe_owner(signal));
      if (lockstep.options().ends_on_timeout) {
        throw SimulationError("lockstep", session.now(), sentence);
      }
      lockstep.suspend(session.now());
      lock.unlock();
      notify_(Level::kWarning, sentence + "; the run goes on without it");
      lock.lock();
      break;
    }
    // Without a poke, the caller looks for an interrupt first.
    const bool was_poked = wait(lock, kLongestWait);
    pacer_.rebase();
    if (!was_poked || reset_seed_ || !stop_reason_.empty()) return false;
    if (paused_ && steps_left_ == 0) return false;
  }
  if (!lockstep.is_suspended()) until = std::min(until, lockstep.due() - Duration{1});
  return true;
}

std::string RunControl::describe_owner(const std::string& signal) const {
  const auto owner = owners_.find(signal);
  if (owner == owners_.end()) return " (no peer has commanded it)";
  return fmt::format(" (the last one came from {})", owner->second.peer);
}

void RunControl::give(Session& session, std::vector<PeerCommand> commands) {
  for (PeerCommand& each : commands) {
    try {
      session.command(std::move(each.command));
    } catch (const ConfigError& error) {
      if (each.refused) each.refused(error.what());
    }
  }
}

void RunControl::end(Session& session) {
  Answer stepping;
  std::vector<Answer> resetting;
  bool made = false;
  {
    const Lock lock(mutex_);
    note_progress(session);
    made = steps_left_ == 0;
    steps_left_ = 0;
    snapshot_.state = RunState::kOver;
    stepping = std::exchange(step_answer_, nullptr);
    resetting = std::exchange(reset_answers_, {});
  }
  if (stepping) stepping(made ? "" : "the run ended before the last step");
  for (const Answer& answer : resetting) answer("the run is over, and its files are written");
}

}  // namespace vinerow::live
