/// One suite for every registered sensor.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/engine/sensors/conformance_bench.h"
#include "tests/support/no_alloc.h"

namespace vinerow::sensors::conformance_test {
namespace {

using test::ConformanceBench;
using test::digest_of;

/// Of these every reading follows from the truth alone.
bool draws_random_numbers(const std::string& sensor) {
  return sensor != "camera_trigger";
}

class SensorConformance : public ::testing::TestWithParam<std::string> {};

TEST_P(SensorConformance, SameSeedSameBitsOtherSeedOthers) {
  const auto digest = [&](std::uint64_t seed) {
    ConformanceBench bench(GetParam(), {}, seed);
    Hasher hasher;
    for (int i = 0; i < 100; ++i) {
      bench.step(i);
      bench.reading->hash_into(hasher);
    }
    EXPECT_GT(bench.reading->sequence(), 0u) << "it says nothing at all";
    return hasher.hex();
  };
  EXPECT_EQ(digest(1), digest(1));
  EXPECT_EQ(digest(1) != digest(2), draws_random_numbers(GetParam()));
}

TEST_P(SensorConformance, AStepAllocatesNothingAndWritesNoNan) {
  ConformanceBench plain(GetParam());
  ConformanceBench late(GetParam(), {{"delay_s", 0.25}, {"dropout_share", 0.5}});
  // Signals get their memory with the first values.
  for (int i = 0; i < 100; ++i) {
    plain.step(i), late.step(i);
    if (late.time_of(i).ns >= 250'000'000) late.sensor->deliver(late.time_of(i));
  }
  const test::AllocationCounter counter;
  for (int i = 100; i < 200; ++i) {
    plain.step(i), late.step(i);
    late.sensor->deliver(late.time_of(i));
  }
  EXPECT_EQ(counter.count(), 0u);
  for (ConformanceBench* bench : {&plain, &late}) {
    EXPECT_FALSE(bench->reading->has_nan());
    EXPECT_FALSE(bench->exact->has_nan());
  }
}

TEST_P(SensorConformance, HasTheParametersOfEveryReadingOnce) {
  const PartSpec& spec = test::sensor_registry().spec(PartKind::kSensor, GetParam());
  EXPECT_GT(spec.default_rate_Hz, 0.0);
  for (const char* name : {"delay_s", "dropout_share", "outages"}) {
    EXPECT_EQ(std::count_if(spec.parameters.begin(), spec.parameters.end(),
                            [&](const ParameterSpec& p) { return p.name == name; }),
              1)
        << name;
  }
}

TEST_P(SensorConformance, LaysTheTruthBesideEveryReading) {
  ConformanceBench bench(GetParam());
  ASSERT_NE(bench.exact, nullptr);
  EXPECT_STREQ(bench.exact->type(), bench.reading->type());
  EXPECT_EQ(bench.exact->writer(), bench.reading->writer());
  for (int i = 0; i < 100; ++i) {
    bench.step(i);
    EXPECT_EQ(bench.exact->sequence(), bench.reading->sequence()) << i;
    EXPECT_EQ(bench.exact->stamp().ns, bench.reading->stamp().ns) << i;
  }
  EXPECT_GT(bench.exact->sequence(), 0u);
}

TEST_P(SensorConformance, TheTruthIsTheSameWhateverTheSeed) {
  ConformanceBench one(GetParam(), {}, 1), two(GetParam(), {}, 2);
  for (int i = 0; i < 50; ++i) {
    one.step(i), two.step(i);
    ASSERT_EQ(digest_of(*one.exact), digest_of(*two.exact)) << "tick " << i;
  }
}

TEST_P(SensorConformance, LosesTheShareOfReadingsItSays) {
  constexpr double kShare = 0.3;
  ConformanceBench bench(GetParam(), {{"dropout_share", kShare}});
  constexpr int kReadings = 2'000;
  for (int i = 0; bench.exact->sequence() < kReadings; ++i) {
    ASSERT_LT(i, 100'000) << "it reads too seldom for this test";
    bench.step(i);
  }
  const double lost = 1.0 - static_cast<double>(bench.reading->sequence()) / kReadings;
  // Five standard deviations of the binomial distribution.
  EXPECT_NEAR(lost, kShare, 5.0 * std::sqrt(kShare * (1.0 - kShare) / kReadings));
}

TEST_P(SensorConformance, LostReadingsLeaveTheOthersAsTheyAre) {
  ConformanceBench whole(GetParam()), holed(GetParam(), {{"dropout_share", 0.5}});
  std::uint64_t seen = 0;
  for (int i = 0; i < 200; ++i) {
    whole.step(i), holed.step(i);
    EXPECT_EQ(digest_of(*whole.exact), digest_of(*holed.exact)) << "tick " << i;
    if (holed.reading->sequence() == seen) continue;
    seen = holed.reading->sequence();
    EXPECT_EQ(digest_of(*whole.reading), digest_of(*holed.reading)) << "tick " << i;
  }
  EXPECT_GT(seen, 0u);
  EXPECT_LT(seen, whole.reading->sequence());
}

TEST_P(SensorConformance, KeepsTimeWhereReadingsComeLateAndSomeNever) {
  ConformanceBench prompt(GetParam(), {{"dropout_share", 0.5}});
  // Two and a half ticks late: a delay that is no multiple of the period.
  const double delay_s = 2.5 * prompt.period.s();
  ConformanceBench late(GetParam(), {{"dropout_share", 0.5}, {"delay_s", delay_s}});
  ASSERT_EQ(late.sensor->delay().ns, prompt.period.ns * 5 / 2);
  constexpr int kTicks = 300;
  std::vector<std::string> written(kTicks);  // at this tick without delay; empty: nothing
  std::uint64_t seen_prompt = 0, seen_late = 0;
  for (int i = 0; i < kTicks; ++i) {
    prompt.step(i);
    if (prompt.reading->sequence() != seen_prompt) written[i] = digest_of(*prompt.reading);
    seen_prompt = prompt.reading->sequence();
    late.step(i);
    EXPECT_EQ(digest_of(*prompt.exact), digest_of(*late.exact)) << "the truth is never late";
    // In the half period that follows, what tick i - 2 measured arrives.
    if (i < 2) continue;
    late.sensor->deliver(Time{late.time_of(i).ns + late.period.ns / 2});
    const bool arrived = late.reading->sequence() != seen_late;
    seen_late = late.reading->sequence();
    ASSERT_EQ(arrived, !written[i - 2].empty()) << "tick " << i;
    if (!arrived) continue;
    // Of a sensor that measures in its whole period the stamp is the start of the period.
    const int first = late.sensor->sampling().ns > 0 ? i - 3 : i - 2;
    EXPECT_EQ(late.reading->stamp().ns, late.time_of(first).ns);
    EXPECT_EQ(digest_of(*late.reading), written[i - 2]) << "tick " << i;
  }
  EXPECT_GT(seen_late, 0u);
}

INSTANTIATE_TEST_SUITE_P(All, SensorConformance,
                         ::testing::ValuesIn(test::sensor_registry().names(PartKind::kSensor)),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace vinerow::sensors::conformance_test
