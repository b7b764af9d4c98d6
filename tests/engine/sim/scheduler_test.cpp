#include "engine/sim/scheduler.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"

namespace vinerow::scheduler_test {
namespace {

TEST(Scheduler, AnHourHoldsExactlyTheSamplesOfEachRate) {
  Scheduler scheduler(Duration{1'000'000});
  std::int64_t counts[3] = {0, 0, 0};
  const double rates_Hz[3] = {5.0, 20.0, 100.0};
  for (int i = 0; i < 3; ++i) {
    scheduler.add(Stage::kSense, "s", period_of_rate(rates_Hz[i]), {},
                  [&counts, i](Time) { ++counts[i]; });
  }
  // [0, 3600) s in steps of 1 ms.
  for (std::int64_t k = 0; k < 3'600'000; ++k) scheduler.run_due(Time{k * 1'000'000});
  EXPECT_EQ(counts[0], 18'000);
  EXPECT_EQ(counts[1], 72'000);
  EXPECT_EQ(counts[2], 360'000);
}

TEST(Scheduler, InsideAnInstantStagesKeepTheirOrderWhateverTheOrderOfAdding) {
  Scheduler scheduler(Duration{10});
  std::string order;
  const auto add = [&](Stage stage, char letter) {
    scheduler.add(stage, std::string(1, letter), Duration{10}, {},
                  [&order, letter](Time) { order += letter; });
  };
  add(Stage::kJudge, 'j'), add(Stage::kControl, 'c'), add(Stage::kSense, 's'),
      add(Stage::kActuate, 'a');
  add(Stage::kEstimate, 'e'), add(Stage::kSense, 't'), add(Stage::kGuide, 'g'),
      add(Stage::kPlan, 'p');
  scheduler.run_due(Time{0});
  EXPECT_EQ(order, "stepgcaj");
}

std::int64_t fake_ns = 0;  // a clock is a plain function
int clock_reads = 0;
std::int64_t read_fake_clock() {
  ++clock_reads;
  return fake_ns;
}

TEST(Scheduler, EachTaskHasItsOwnTimeAndNobodyThatBetweenInstants) {
  Scheduler scheduler(Duration{10});
  fake_ns = clock_reads = 0;
  scheduler.set_clock(read_fake_clock, true);
  scheduler.add(Stage::kSense, "a", Duration{10}, {}, [](Time) { fake_ns += 30; });
  scheduler.add(Stage::kPlan, "rare", Duration{20}, {}, [](Time) { fake_ns += 500; });
  scheduler.add(Stage::kControl, "b", Duration{10}, {}, [](Time) { fake_ns += 7; });
  for (int k = 0; k < 4; ++k) {
    scheduler.run_due(Time{k * 10});
    fake_ns += 1000;
  }
  const std::vector<Scheduler::TaskReport> reports = scheduler.reports();
  ASSERT_EQ(reports.size(), 3u);
  EXPECT_NEAR(reports[0].wall_s, 4 * 30e-9, 1e-15);
  EXPECT_NEAR(reports[1].wall_s, 2 * 500e-9, 1e-15);
  EXPECT_NEAR(reports[2].wall_s, 4 * 7e-9, 1e-15);
  EXPECT_EQ(clock_reads, 2 * 4 + 2 * 3) << "one for the instant and one for each tick";
  // Beside the rare one: the other two. Without it: the shorter one.
  EXPECT_NEAR(scheduler.two_cores_save_s(), (2 * 37 + 2 * 7) * 1e-9, 1e-15);
}

TEST(Scheduler, TwoCoresSaveHalfAtMost) {
  Scheduler scheduler(Duration{10});
  fake_ns = 0;
  for (const char* name : {"a", "b", "c"}) {
    scheduler.add(Stage::kSense, name, Duration{10}, {}, [](Time) { fake_ns += 10; });
  }
  scheduler.run_due(Time{0});
  EXPECT_EQ(scheduler.two_cores_save_s(), 0.0) << "without a clock";
  scheduler.set_clock(read_fake_clock, true);
  scheduler.run_due(Time{10});
  EXPECT_NEAR(scheduler.two_cores_save_s(), 15e-9, 1e-15);
}

TEST(Scheduler, AnOffsetDelaysTheFirstTick) {
  Scheduler scheduler(Duration{10});
  std::vector<std::int64_t> ticks;
  scheduler.add(Stage::kSense, "s", Duration{30}, Duration{20},
                [&](Time t) { ticks.push_back(t.ns); });
  for (int k = 0; k < 10; ++k) scheduler.run_due(Time{k * 10});
  EXPECT_EQ(ticks, (std::vector<std::int64_t>{20, 50, 80}));
}

TEST(Scheduler, ATaskAddedLaterBeginsThere) {
  Scheduler scheduler(Duration{10});
  std::vector<std::int64_t> ticks;
  for (int k = 0; k < 10; ++k) {
    // 45 is no instant of a task that began at 0.
    if (k == 4) {
      scheduler.add(
          Stage::kSense, "s", Duration{20}, Duration{10}, [&](Time t) { ticks.push_back(t.ns); },
          Time{40});
    }
    scheduler.run_due(Time{k * 10});
  }
  EXPECT_EQ(ticks, (std::vector<std::int64_t>{50, 70, 90}));
}

TEST(Scheduler, ATaskTakenAwayRunsNoMoreAndItsTicksAreKept) {
  Scheduler scheduler(Duration{10});
  int ticks = 0;
  const int task = scheduler.add(Stage::kSense, "s", Duration{10}, {}, [&](Time) { ++ticks; });
  for (int k = 0; k < 3; ++k) scheduler.run_due(Time{k * 10});
  scheduler.remove(task);
  for (int k = 3; k < 9; ++k) scheduler.run_due(Time{k * 10});
  EXPECT_EQ(ticks, 3);
  ASSERT_EQ(scheduler.reports().size(), 1u);
  EXPECT_EQ(scheduler.reports()[0].ticks, 3u);
}

TEST(Scheduler, PeriodsThatTheStepDoesNotDivideAreRefusedWithBothNumbers) {
  Scheduler scheduler(Duration{1'000'000});
  try {
    scheduler.add(Stage::kSense, "rover.sensors.camera", period_of_rate(30.0), {}, [](Time) {});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "rover.sensors.camera: its period of 0.033333333 s is not a multiple of the "
                 "physics step of 0.001 s");
  }
  EXPECT_THROW(scheduler.add(Stage::kSense, "s", Duration{2'000'000}, Duration{1}, [](Time) {}),
               ConfigError);
}

}  // namespace
}  // namespace vinerow::scheduler_test
