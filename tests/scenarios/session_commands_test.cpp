/// Commands from outside: when they act, and what is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "engine/core/error.h"
#include "tests/scenarios/session_support.h"
#include "vinerow/testing.h"

namespace vinerow::session_commands_test {
namespace {

using ::testing::HasSubstr;
using test::all_of;
using test::kFreeRover;

constexpr const char* kActuators = "rover/actuators";

NamedValues wheels(double left_radps, double right_radps) {
  return {{"wheel_fl_speed_radps", "wheel_fr_speed_radps", "wheel_rl_speed_radps",
           "wheel_rr_speed_radps"},
          {left_radps, right_radps, left_radps, right_radps}};
}

Session open_free_rover(const ScenarioChanges& changes = {}) {
  return open_session_text(kFreeRover, ".", changes,
                           SessionOptions().take_over<NamedValues>(kActuators));
}

TEST(SessionCommand, DrivesAVehicleWithoutAController) {
  Session session = open_free_rover();
  const auto truth = session.signal<Odometry>("rover/truth");
  session.advance_for(Duration{1'000'000'000});
  const double start_m = truth.value().X_WB.p.norm();
  EXPECT_LT(truth.value().v_WB_B.norm(), 0.01);
  session.command(kActuators, session.now(), wheels(4, 4));
  session.advance_for(Duration{2'000'000'000});
  EXPECT_GT(truth.value().v_WB_B.x(), 0.3);
  EXPECT_GT(std::abs(truth.value().X_WB.p.norm() - start_m), 0.3);
  EXPECT_FALSE(session.finished()) << "nobody can say so";
}

TEST(SessionCommand, ActsAtTheFirstInstantThatIsNotBeforeItsStamp) {
  Session session = open_free_rover();
  const auto actuators = session.signal<NamedValues>(kActuators);
  session.command(kActuators, Time{1'500'000}, wheels(1, 1));
  session.advance(Time{1'000'000});
  EXPECT_FALSE(actuators.has_value());
  session.advance(Time{2'000'000});
  EXPECT_EQ(actuators.stamp().ns, 2'000'000);
  EXPECT_EQ(actuators.value().values, wheels(1, 1).values);
  EXPECT_EQ(session.any_signal(kActuators).writer(), "outside");
  session.command(kActuators, session.now(), wheels(2, 2));
  session.advance_for(session.step());
  EXPECT_EQ(actuators.stamp().ns, 3'000'000);
}

TEST(SessionCommand, OfSeveralAtOneInstantTheLatestCounts) {
  Session session = open_free_rover();
  session.command(kActuators, Time{1'900'000}, wheels(3, 3));
  session.command(kActuators, Time{1'500'000}, wheels(1, 1));
  session.command(kActuators, Time{1'900'000}, wheels(4, 4));
  session.advance(Time{2'000'000});
  EXPECT_EQ(session.signal<NamedValues>(kActuators).value().values, wheels(4, 4).values);
}

TEST(SessionCommand, SlicesChangeNothing) {
  const auto command_at = [](std::int64_t ms) { return wheels(0.004 * ms, 0.005 * ms); };
  Session at_once = open_free_rover();
  for (std::int64_t ms = 950; ms >= 0; ms -= 50) {
    at_once.command(kActuators, Time{ms * 1'000'000}, command_at(ms));
  }
  at_once.advance(Time{1'500'000'000});

  Session in_time = open_free_rover();
  for (std::int64_t ms = 0; ms <= 950; ms += 50) {
    in_time.command(kActuators, Time{ms * 1'000'000}, command_at(ms));
    in_time.advance(Time{(ms + 40) * 1'000'000});
    in_time.advance_for(Duration{9'000'000});
  }
  in_time.advance(Time{1'500'000'000});
  EXPECT_EQ(all_of(in_time), all_of(at_once));

  Session other = open_free_rover();
  other.command(kActuators, Time{}, command_at(100));
  other.advance(Time{1'500'000'000});
  EXPECT_NE(other.digest(), at_once.digest());
}

TEST(SessionCommand, IsForgottenByAReset) {
  Session session = open_free_rover();
  session.command(kActuators, Time{500'000'000}, wheels(5, 5));
  session.advance(Time{1'000'000'000});
  session.command(kActuators, Time{1'500'000'000}, wheels(5, 5));
  session.reset();
  session.advance(Time{2'000'000'000});
  Session untouched = open_free_rover();
  untouched.advance(Time{2'000'000'000});
  EXPECT_EQ(all_of(session), all_of(untouched));
}

TEST(SessionCommand, ActuatorsCanBeNamedInAnyNumberAndOrder) {
  Session session = open_free_rover();
  session.command(kActuators, Time{}, NamedValues{{"wheel_fl_speed_radps"}, {3.0}});
  session.command(kActuators, Time{500'000'000}, NamedValues{{"wheel_rr_speed_radps"}, {3.0}});
  Session other = open_free_rover();
  other.command(kActuators, Time{}, NamedValues{{"wheel_fl_speed_radps"}, {3.0}});
  other.command(kActuators, Time{500'000'000}, wheels(3.0, 0.0));
  session.advance(Time{2'000'000'000});
  other.advance(Time{2'000'000'000});
  EXPECT_NE(session.signal<Odometry>("rover/truth").value().X_WB.p,
            other.signal<Odometry>("rover/truth").value().X_WB.p)
      << "the second command moved another wheel";
}

TEST(SessionCommand, TakesThePlaceOfAnOptionalPartToo) {
  // A controller reads an authority to move where somebody writes one.
  auto options = SessionOptions().take_over<MovementAuthority>("rover/authority");
  const std::string yaml = testing::SmallWorld()
                               .vehicle("rover", "diff_drive_rover")
                               .planner("rover", "coverage")
                               .controller("rover", "pure_pursuit", "lookahead_m: 0.5")
                               .yaml();
  Session session = open_session_text(yaml, ".", {}, options);
  MovementAuthority stand;
  stand.stop_at_m = 0.0;
  session.command("rover/authority", Time{}, stand);
  session.advance(Time{3'000'000'000});
  EXPECT_LT(session.metrics().at("rover").at("distance_m"), 0.2);
}

TEST(SessionCommand, SaysWhatIsWrong) {
  Session session = open_free_rover();
  const auto refusal_of = [&](const auto& value, const std::string& signal, Time stamp) {
    try {
      session.command(signal, stamp, value);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  session.advance(Time{100'000'000});
  const Time now = session.now();
  EXPECT_EQ(refusal_of(wheels(1, 1), "rover/actuatrs", now),
            "signal 'rover/actuatrs' is not taken over; did you mean 'rover/actuators'? (taken "
            "over: rover/actuators)");
  EXPECT_EQ(refusal_of(VelocityCommand{}, kActuators, now),
            "signal 'rover/actuators' is NamedValues, not VelocityCommand");
  EXPECT_EQ(refusal_of(wheels(1, 1), kActuators, Time{100'000'000}),
            "a command for 'rover/actuators' at 0.1 s comes too late: the next instant is 0.101 s");
  EXPECT_EQ(refusal_of(Odometry{}, "rover/truth", now),
            "signal 'rover/truth' is written by rover, not from outside (taken over: "
            "rover/actuators)");
  EXPECT_THAT(refusal_of(wheels(std::numeric_limits<double>::quiet_NaN(), 0), kActuators, now),
              HasSubstr("contains NaN"));
  EXPECT_THAT(refusal_of(NamedValues{{"wheel_fl_speed_radp"}, {1.0}}, kActuators, now),
              HasSubstr("wheel_fl_speed_radps"));
  EXPECT_THAT(refusal_of(NamedValues{{"wheel_fl_speed_radps"}, {}}, kActuators, now),
              HasSubstr("has 0 values for 1 names"));
  EXPECT_EQ(refusal_of(wheels(1, 1), kActuators, now), "taken");
}

TEST(SessionCommand, ASignalThatCannotBeTakenOverIsRefusedWhileLoading) {
  const auto refusal_of = [&](const SessionOptions& options, const std::string& yaml) {
    try {
      open_session_text(yaml, ".", {}, options);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_THAT(
      refusal_of(SessionOptions().take_over<NamedValues>("rover/actuatrs"), kFreeRover),
      HasSubstr("signal 'rover/actuatrs' is taken over, but no part reads it; did you mean "
                "'rover/actuators'?"));
  EXPECT_THAT(refusal_of(SessionOptions().take_over<Odometry>("rover/truth"), kFreeRover),
              HasSubstr("signal 'rover/truth' is written by both outside and rover"));
  EXPECT_THAT(refusal_of(SessionOptions().take_over<VelocityCommand>(kActuators), kFreeRover),
              HasSubstr("as NamedValues, but it is VelocityCommand"));
  const std::string driven = testing::SmallWorld()
                                 .vehicle("rover", "diff_drive_rover")
                                 .planner("rover", "coverage")
                                 .controller("rover", "pure_pursuit")
                                 .yaml();
  EXPECT_THAT(refusal_of(SessionOptions().take_over<NamedValues>(kActuators), driven),
              HasSubstr("is written by both outside and rover.controller"));
}

}  // namespace
}  // namespace vinerow::session_commands_test
