/// Control of a run from other threads: what peers ask changes when the run goes on, never its
/// result.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "engine/api/messages/commands.h"
#include "engine/run/command_log.h"
#include "tests/engine/live/live_support.h"
#include "tests/scenarios/command.h"

namespace vinerow::live::run_control_test {
namespace {

using test::answer_of;
using test::BackgroundRun;
using test::remote_rover;
using test::velocity;
using ::testing::HasSubstr;

/// Digest of a run in which nobody commands.
std::string quiet_digest() {
  return test::run_alone(remote_rover()).digest;
}

/// A peer in lock-step: answers each instant that is due with a command that depends on it.
run::RunResult run_in_lockstep(const scenario::Scenario& scenario, const std::filesystem::path& out,
                               std::chrono::milliseconds delay) {
  BackgroundRun run(scenario, {.speed = 0.0}, out);
  run.await([&] { return run.control().snapshot().state != RunState::kStarting; });
  const std::int64_t period = scenario.lockstep.period.ns;
  for (std::int64_t k = 1; k * period <= duration_from_s(scenario.duration_s).ns; ++k) {
    std::this_thread::sleep_for(delay);
    EXPECT_EQ(run.control().submit(velocity("peer", Time{k * period}, 0.01 * k, 0.02 * k)), "");
  }
  return run.join();
}

TEST(RunControl, SpeedPausesAndStepsDoNotChangeTheResult) {
  BackgroundRun run(remote_rover(), {.speed = 0.0, .paused = true});
  run.await_state(RunState::kPaused);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(answer_of([&](Answer answer) { run.control().step(37, std::move(answer)); }), "");
  }
  EXPECT_EQ(run.control().set_speed(20.0), "");
  run.control().resume();
  run.await([&] { return run.control().snapshot().now.s() > 0.5; });
  run.control().pause();
  run.await_state(RunState::kPaused);
  EXPECT_EQ(run.control().set_speed(0.0), "");
  run.control().resume();
  EXPECT_EQ(run.join().digest, quiet_digest());
}

TEST(RunControl, StepsAreExact) {
  BackgroundRun run(remote_rover(), {.speed = 0.0, .paused = true});
  run.await_state(RunState::kPaused);
  EXPECT_EQ(run.control().snapshot().steps, 0);
  EXPECT_EQ(answer_of([&](Answer answer) { run.control().step(1000, std::move(answer)); }), "");
  EXPECT_EQ(run.control().snapshot().steps, 1000);
  EXPECT_EQ(answer_of([&](Answer answer) { run.control().step(1, std::move(answer)); }), "");
  EXPECT_EQ(run.control().snapshot().steps, 1001);
  EXPECT_EQ(run.control().snapshot().state, RunState::kPaused);
  EXPECT_EQ(answer_of([&](Answer answer) { run.control().step(0, std::move(answer)); }), "");
  EXPECT_EQ(run.control().snapshot().steps, 1001);
  EXPECT_EQ(answer_of([&](Answer answer) { run.control().step(1'000'000, std::move(answer)); }),
            "the run ended before the last step");
  EXPECT_EQ(run.join().digest, quiet_digest());
  EXPECT_EQ(answer_of([&](Answer answer) { run.control().step(1, std::move(answer)); }),
            "the run is over");
}

TEST(RunControl, StepsNeedAPause) {
  BackgroundRun run(remote_rover(), {.speed = 1.0});
  run.await_state(RunState::kPlaying);
  EXPECT_EQ(answer_of([&](Answer answer) { run.control().step(1, std::move(answer)); }),
            "the run is not paused: pause it before stepping");
}

TEST(RunControl, AResetStartsAgain) {
  const test::ScratchFolder folder("live_reset");
  BackgroundRun run(remote_rover(), {.speed = 0.0, .paused = true}, folder.path());
  run.await_state(RunState::kPaused);
  EXPECT_EQ(answer_of([&](Answer answer) { run.control().step(700, std::move(answer)); }), "");
  EXPECT_EQ(answer_of([&](Answer answer) { run.control().reset(std::nullopt, std::move(answer)); }),
            "");
  const RunSnapshot snapshot = run.control().snapshot();
  EXPECT_EQ(snapshot.steps, 0);
  EXPECT_EQ(snapshot.restarts, 1);
  EXPECT_EQ(snapshot.state, RunState::kPaused);
  run.control().resume();
  const run::RunResult result = run.join();
  EXPECT_EQ(result.digest, quiet_digest());
  // The files are those of the run that went to its end.
  EXPECT_EQ(run::read_command_log(folder.path() / "log.mcap").digest, result.digest);
  EXPECT_EQ(answer_of([&](Answer answer) { run.control().reset(std::nullopt, std::move(answer)); }),
            "the run is over, and its files are written");
}

TEST(RunControl, AResetTakesAnotherSeed) {
  BackgroundRun run(remote_rover(), {.speed = 0.0, .paused = true});
  run.await_state(RunState::kPaused);
  EXPECT_EQ(answer_of([&](Answer answer) { run.control().reset(7, std::move(answer)); }), "");
  run.control().resume();
  scenario::Scenario other = remote_rover("seed: 7\n");
  EXPECT_EQ(run.join().digest, test::run_alone(other).digest);
}

TEST(RunControl, CommandsAreInTheRecordAndAReplayRepeatsThem) {
  const test::ScratchFolder folder("live_replay");
  std::string digest;
  {
    BackgroundRun run(remote_rover(), {.speed = 4.0}, folder.path());
    run.await([&] { return run.control().snapshot().now.s() > 0.1; });
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(run.control().submit(velocity("joystick", Time{}, 0.5, 0.1 * i)), "");
      std::this_thread::sleep_for(std::chrono::milliseconds(11));
    }
    digest = run.join().digest;
  }
  EXPECT_NE(digest, quiet_digest());
  const run::CommandLog log = run::read_command_log(folder.path() / "log.mcap");
  EXPECT_EQ(log.digest, digest);
  EXPECT_EQ(log.signals, std::vector<std::string>{"rover/cmd_vel"});
  EXPECT_GE(log.commands.size(), 10);
  EXPECT_LE(log.commands.size(), 20);
  const auto replay = std::make_shared<run::CommandReplay>(log);
  EXPECT_EQ(test::run_alone(remote_rover(), replay).digest, digest);
}

TEST(RunControl, AReplayEndsWhereTheRunWasEnded) {
  const test::ScratchFolder folder("live_ended");
  std::string digest;
  {
    BackgroundRun run(remote_rover(), {.speed = 1.0}, folder.path());
    run.await([&] { return run.control().snapshot().now.s() > 0.2; });
    EXPECT_EQ(run.control().submit(velocity("joystick", Time{}, 1.0)), "");
    run.await([&] { return run.control().snapshot().now.s() > 0.4; });
    run.control().stop("ended by a client");
    const run::RunResult result = run.join();
    EXPECT_EQ(result.status, run::RunStatus::kBrokenOff);
    EXPECT_THAT(result.error, HasSubstr("ended by a client"));
    digest = result.digest;
  }
  const auto commands =
      std::make_shared<run::CommandReplay>(run::read_command_log(folder.path() / "log.mcap"));
  const run::RunResult replay = test::run_alone(remote_rover(), commands);
  EXPECT_EQ(replay.digest, digest);
  EXPECT_THAT(replay.error, HasSubstr("was ended here from outside"));
}

TEST(RunControl, LockstepGivesTheSameBitsHoweverSlowThePeerIs) {
  const test::ScratchFolder folder("live_lockstep");
  const scenario::Scenario scenario = remote_rover(test::kLockstep);
  const std::string quick =
      run_in_lockstep(scenario, folder.path(), std::chrono::milliseconds(0)).digest;
  EXPECT_NE(quick, quiet_digest());
  EXPECT_EQ(run_in_lockstep(scenario, {}, std::chrono::milliseconds(10)).digest, quick);
  const run::CommandLog log = run::read_command_log(folder.path() / "log.mcap");
  ASSERT_EQ(log.commands.size(), 40);
  for (std::size_t k = 0; k < log.commands.size(); ++k) {
    EXPECT_EQ(log.commands[k].stamp.ns, static_cast<std::int64_t>(k + 1) * 50'000'000)
        << "a command takes effect at the instant for which it is stamped";
  }
  const auto replay = std::make_shared<run::CommandReplay>(log);
  EXPECT_EQ(test::run_alone(scenario, replay).digest, quick);
}

TEST(RunControl, LockstepWithoutAPeerEnds) {
  const std::string lockstep = "lockstep: {topic: /rover/cmd_vel, rate_Hz: 20, timeout_s: 0.2}\n";
  BackgroundRun run(remote_rover(lockstep), {.speed = 0.0});
  const run::RunResult result = run.join();
  EXPECT_EQ(result.status, run::RunStatus::kBrokenOff);
  EXPECT_EQ(result.error,
            "t = 0.050000 s: lockstep: no command for 'rover/cmd_vel' stamped 0.05 s "
            "has come for 0.2 s (no peer has commanded it)");
}

TEST(RunControl, LockstepGoesOnIfTheScenarioWantsThat) {
  const std::string lockstep =
      "lockstep: {topic: rover/cmd_vel, rate_Hz: 20, timeout_s: 0.2, on_timeout: continue}\n";
  BackgroundRun run(remote_rover(lockstep), {.speed = 2.0});
  run.await_state(RunState::kPlaying);
  EXPECT_EQ(run.control().submit(velocity("peer", Time{50'000'000}, 0.5)), "");
  run.await([&] { return run.control().snapshot().now.s() > 0.3; });
  EXPECT_THAT(run.said(), HasSubstr("stamped 0.1 s has come for 0.2 s (the last one came from "
                                    "peer); the run goes on without it"));
  EXPECT_EQ(run.join().status, run::RunStatus::kAllMet);
}

TEST(RunControl, APeerKeepsItsSignal) {
  BackgroundRun run(remote_rover(), {.speed = 1.0});
  run.await_state(RunState::kPlaying);
  EXPECT_EQ(run.control().submit(velocity("A", Time{}, 0.5)), "");
  EXPECT_EQ(run.control().submit(velocity("B", Time{}, 0.1)),
            "'rover/cmd_vel' is commanded by A; another peer can take over 1 s after its last "
            "command");
  run.control().release("A");
  EXPECT_EQ(run.control().submit(velocity("B", Time{}, 0.1)), "");
}

TEST(RunControl, RefusesWhatCannotBeACommand) {
  BackgroundRun run(remote_rover(), {.speed = 1.0});
  run.await_state(RunState::kPlaying);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(run.control().submit(velocity("A", Time{}, nan)),
            "the command for 'rover/cmd_vel' contains NaN");
  PeerCommand other{outside_command("rover/cmd_val", Time{}, VelocityCommand{}), "A"};
  EXPECT_EQ(run.control().submit(std::move(other)),
            "no part takes commands from outside as 'rover/cmd_val'; did you mean "
            "'rover/cmd_vel'? (there are: rover/cmd_vel)");
  EXPECT_THAT(run.control().set_speed(nan), HasSubstr("must be within [0, 1e+06]"));
  EXPECT_THAT(run.control().set_speed(-1.0), HasSubstr("speed = -1"));
}

TEST(RunControl, PassesOnWhatTheRunRefuses) {
  const std::string text = std::string(test::kRemoteRover);
  std::string changed = text;
  changed.replace(changed.find("remote_velocity"), 15, "remote_actuators");
  BackgroundRun run(scenario::parse_scenario(changed, ".", test::all_parts()), {.speed = 1.0});
  run.await_state(RunState::kPlaying);
  const std::string refusal = answer_of([&](Answer answer) {
    PeerCommand command{
        outside_command("rover/actuator_command", Time{}, NamedValues{{"wheel_x"}, {1.0}}), "A",
        std::move(answer)};
    EXPECT_EQ(run.control().submit(std::move(command)), "");
  });
  EXPECT_THAT(refusal, HasSubstr("a command for 'rover/actuator_command'"));
  EXPECT_THAT(refusal, HasSubstr("wheel_x"));
}

TEST(RunControl, ARunWithoutSuchAPartTakesNoCommand) {
  std::string text = test::kRemoteRover;
  text.erase(text.find("    controller:"));
  BackgroundRun run(scenario::parse_scenario(text, ".", test::all_parts()), {.speed = 1.0});
  run.await_state(RunState::kPlaying);
  EXPECT_EQ(run.control().submit(velocity("A", Time{}, 0.5)),
            "no part of this run takes commands from outside");
}

}  // namespace
}  // namespace vinerow::live::run_control_test
