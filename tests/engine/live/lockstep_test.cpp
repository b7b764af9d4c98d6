/// Which commands lock-step takes, and when.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/api/messages/commands.h"
#include "engine/live/lockstep.h"

namespace vinerow::live::lockstep_test {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;

Lockstep make(double timeout_s = 1.0) {
  scenario::LockstepConfig options;
  options.signal = "rover/cmd_vel";
  options.period = Duration{50 * kMs};
  options.timeout_s = timeout_s;
  return Lockstep(options);
}

PeerCommand at(std::int64_t stamp_ms, double v_mps = 1.0) {
  return {outside_command("rover/cmd_vel", Time{stamp_ms * kMs}, VelocityCommand{v_mps, 0}),
          "peer"};
}

double speed_of(const PeerCommand& command) {
  return static_cast<const Signal<VelocityCommand>&>(*command.command.value).value().v_mps;
}

TEST(Lockstep, GivesCommandsInTheOrderOfTheirInstants) {
  Lockstep lockstep = make();
  EXPECT_EQ(lockstep.due().ns, 50 * kMs);
  EXPECT_FALSE(lockstep.take());
  EXPECT_EQ(lockstep.add(at(100, 2.0)), "");
  EXPECT_FALSE(lockstep.take()) << "the one of 50 ms is missing";
  EXPECT_EQ(lockstep.add(at(50, 1.0)), "");
  EXPECT_EQ(speed_of(*lockstep.take()), 1.0);
  EXPECT_EQ(speed_of(*lockstep.take()), 2.0);
  EXPECT_EQ(lockstep.due().ns, 150 * kMs);
}

TEST(Lockstep, RefusesWhatFitsNoInstant) {
  Lockstep lockstep = make();
  EXPECT_EQ(lockstep.add(at(0)),
            "the command for 'rover/cmd_vel' stamped 0 s comes too late: the next one is due at "
            "0.05 s");
  EXPECT_EQ(lockstep.add(at(70)),
            "the command for 'rover/cmd_vel' stamped 0.07 s is not at a multiple of 0.05 s");
  EXPECT_EQ(lockstep.add(at(50)), "");
  EXPECT_THAT(lockstep.add(at(50)), HasSubstr("is a second one"));
  for (int k = 2; k <= 1000; ++k) EXPECT_EQ(lockstep.add(at(50 * k)), "");
  EXPECT_THAT(lockstep.add(at(50 * 1001)), HasSubstr("is one of more than 1000 in advance"));
}

TEST(Lockstep, TimesOutOnceItHasWaited) {
  Lockstep lockstep = make(0.5);
  const Lockstep::Clock::time_point start{};
  EXPECT_FALSE(lockstep.has_timed_out(start + milliseconds(900))) << "the wait begins now";
  EXPECT_FALSE(lockstep.has_timed_out(start + milliseconds(1300)));
  EXPECT_TRUE(lockstep.has_timed_out(start + milliseconds(1400)));
}

TEST(Lockstep, GoesOnWithoutCommandsUntilOneComes) {
  Lockstep lockstep = make();
  lockstep.suspend(Time{50 * kMs});
  EXPECT_TRUE(lockstep.is_suspended());
  lockstep.pass(Time{420 * kMs});
  EXPECT_EQ(lockstep.due().ns, 450 * kMs);
  EXPECT_THAT(lockstep.add(at(400)), HasSubstr("too late"));
  EXPECT_TRUE(lockstep.is_suspended());
  EXPECT_EQ(lockstep.add(at(450)), "");
  EXPECT_FALSE(lockstep.is_suspended());
  EXPECT_TRUE(lockstep.take());
}

TEST(Lockstep, ForgetsEverythingWhenTheRunStartsAgain) {
  Lockstep lockstep = make();
  EXPECT_EQ(lockstep.add(at(50)), "");
  EXPECT_EQ(lockstep.add(at(100)), "");
  EXPECT_TRUE(lockstep.take());
  lockstep.restart();
  EXPECT_EQ(lockstep.due().ns, 50 * kMs);
  EXPECT_FALSE(lockstep.take());
}

}  // namespace
}  // namespace vinerow::live::lockstep_test
