#include "engine/api/signal.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/sensors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"

namespace vinerow::signal_test {
namespace {

TEST(Signal, ReadersSeeTheLastValueWithItsTime) {
  SignalBus bus;
  Ports writer(bus, "rover", "rover.controller"), reader(bus, "rover", "rover.metric");
  auto in = reader.read<VelocityCommand>("command");
  auto out = writer.write<VelocityCommand>("command");
  EXPECT_FALSE(in.has_value());
  out.write(Time{5}, {1.0, 0.5});
  EXPECT_TRUE(in.has_value());
  EXPECT_EQ(in.value().v_mps, 1.0);
  EXPECT_EQ(in.stamp().ns, 5);
  std::uint64_t seen = 0;
  EXPECT_TRUE(in.is_newer_than(seen));
  EXPECT_FALSE(in.is_newer_than(seen));
}

TEST(Signal, MayBeInTheFrameOfAnotherOne) {
  SignalBus bus;
  Ports estimator(bus, "rover", "rover.estimator");
  Ports observer(bus, "rover", "rover.observers.second", {{"labels", "second_labels"}});
  estimator.write<Odometry>("estimate");
  estimator.write_in_frame_of<Odometry>("front", "labels");
  observer.write_in_frame_of<Odometry>("front", "labels");
  EXPECT_EQ(bus.find("rover/estimate")->frame_source(), "");
  EXPECT_EQ(bus.find("rover/labels")->frame_source(), "rover/front");
  EXPECT_EQ(bus.find("rover/second_labels")->frame_source(), "rover/front");
}

TEST(Signal, WrongWiresAreRefused) {
  SignalBus bus;
  bus.advertise<Odometry>("rover/truth", "rover");
  try {
    bus.advertise<Odometry>("rover/truth", "other");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "signal 'rover/truth' is written by both rover and other");
  }
  try {
    bus.subscribe<ImuSample>("rover/truth", "rover.estimator");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "rover.estimator takes signal 'rover/truth' as ImuSample, but it is Odometry");
  }
  bus.subscribe<Odometry>("rover/trut", "rover.controller");
  try {
    bus.check_connected();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "rover.controller reads signal 'rover/trut', which nobody writes; did you mean "
                 "'truth'? (written in 'rover/': truth)");
  }
}

TEST(Signal, ThePartThatMayAddAMissingSignalIsNamed) {
  SignalBus bus;
  bus.advertise<Odometry>("rover/front", "rover.sensors.front");
  bus.advertise<Odometry>("drone/front_sem", "drone.sensors.front");
  bus.subscribe<Odometry>("rover/front_semantic", "rover.estimator");
  try {
    bus.check_connected();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "rover.estimator reads signal 'rover/front_semantic', which nobody writes; "
                 "rover.sensors.front writes 'front': does one of its parameters add '_semantic'? "
                 "(written in 'rover/': front)");
  }
}

TEST(Signal, OptionalReadersNeedNoWriter) {
  SignalBus bus;
  const auto reader = bus.subscribe_optional<BatteryState>("rover/battery", "rover.metric");
  EXPECT_NO_THROW(bus.check_connected());
  EXPECT_FALSE(reader.has_value());
}

TEST(SignalBus, AReleasedSignalIsNewToItsReadersAndFreeForAnotherWriter) {
  SignalBus bus;
  auto writer = bus.advertise<VelocityCommand>("rover/command", "rover.controller");
  auto other = bus.advertise<VelocityCommand>("rover/truth", "rover");
  const auto reader = bus.subscribe<VelocityCommand>("rover/command", "test");
  const auto truth = bus.subscribe<VelocityCommand>("rover/truth", "test");
  writer.write(Time{1}, {2.0, 0.0});
  other.write(Time{1}, {3.0, 0.0});
  bus.release("rover");
  EXPECT_FALSE(reader.has_value());
  EXPECT_TRUE(truth.has_value()) << "the vehicle itself is not below 'rover'";
  std::uint64_t seen = 0;
  EXPECT_FALSE(reader.is_newer_than(seen));
  writer = bus.advertise<VelocityCommand>("rover/command", "rover.controller");
  writer.write(Time{2}, {4.0, 0.0});
  EXPECT_TRUE(reader.is_newer_than(seen));
  EXPECT_EQ(reader.sequence(), 1u);
  EXPECT_EQ(reader.value().v_mps, 4.0);
  // The bus counts on, so that log and digest miss nothing.
  EXPECT_EQ(bus.find("rover/command")->sequence(), 2u);
}

TEST(Signal, DigestSeesNameTimeAndEveryField) {
  const auto digest = [](const char* name, Time time, double v) {
    Signal<VelocityCommand> signal(name);
    signal.write(time, {v, 0.0});
    Hasher hasher;
    signal.hash_into(hasher);
    return hasher.hex();
  };
  const std::string base = digest("a/command", Time{1}, 2.0);
  EXPECT_EQ(base, digest("a/command", Time{1}, 2.0));
  EXPECT_NE(base, digest("b/command", Time{1}, 2.0));
  EXPECT_NE(base, digest("a/command", Time{2}, 2.0));
  EXPECT_NE(base, digest("a/command", Time{1}, 2.5));
}

TEST(Signal, NanIsFoundAndInfinityIsNot) {
  Signal<RangeSample> range("rover/sonar");
  RangeSample sample;
  sample.range_m = INFINITY;
  range.write(Time{0}, sample);
  EXPECT_FALSE(range.has_nan());
  sample.range_m = NAN;
  range.write(Time{1}, sample);
  EXPECT_TRUE(range.has_nan());
}

}  // namespace
}  // namespace vinerow::signal_test
