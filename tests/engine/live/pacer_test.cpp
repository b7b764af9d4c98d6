/// Speed of a run against wall time, with a clock of the test.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/live/pacer.h"

namespace vinerow::live::pacer_test {
namespace {

using std::chrono::duration;
using std::chrono::duration_cast;
using ::testing::HasSubstr;

constexpr Duration kLongest{250'000'000};

/// A run whose slices take `cost` wall seconds per simulated second.
struct PacedRun {
  Pacer pacer;
  double cost = 0.0;
  Pacer::Clock::time_point wall{};
  Time now{};
  std::string said{};

  void advance_to(double simulated_s) {
    while (now.s() < simulated_s) {
      const Pacer::Plan plan = pacer.plan(now, wall, kLongest);
      said += pacer.take_lag();
      if (plan.wait.count() > 0) {
        wall += plan.wait;
        continue;
      }
      now = now + plan.slice;
      wall += duration_cast<Pacer::Clock::duration>(duration<double>(cost * plan.slice.s()));
      pacer.measure(now, wall);
    }
  }
  double wall_s() const { return duration<double>(wall.time_since_epoch()).count(); }
};

TEST(Pacer, HoldsASpeed) {
  for (const double speed : {0.25, 1.0, 5.0}) {
    PacedRun run;
    run.cost = 0.01;
    run.pacer.set_speed(speed);
    run.advance_to(10.0);
    EXPECT_NEAR(run.wall_s(), 10.0 / speed, 0.02) << speed;
    EXPECT_NEAR(run.pacer.measure(run.now, run.wall), speed, 0.05 * speed);
    EXPECT_EQ(run.said, "");
  }
}

TEST(Pacer, SaysWhenTheSpeedCannotBeHeld) {
  PacedRun run;
  run.cost = 0.5;  // twice real time at best
  run.pacer.set_speed(5.0);
  run.advance_to(8.0);
  EXPECT_NEAR(run.wall_s(), 4.0, 0.01) << "it does not wait";
  EXPECT_EQ(
      run.said,
      "the run cannot hold 5 times real time: it makes 2 (the result does not depend on that)")
      << "once in 10 s";
  run.advance_to(30.0);
  EXPECT_EQ(std::count(run.said.begin(), run.said.end(), ':'), 2);
}

TEST(Pacer, DoesNotCatchUpWhatAPauseTook) {
  PacedRun run;
  run.pacer.set_speed(1.0);
  run.advance_to(1.0);
  run.wall += std::chrono::seconds(100);
  run.pacer.rebase();
  const double before_s = run.wall_s();
  run.advance_to(2.0);
  EXPECT_NEAR(run.wall_s() - before_s, 1.0, 0.02);
  EXPECT_EQ(run.said, "");
}

TEST(Pacer, WithoutALimitSlicesTakeAHundredthOfASecond) {
  PacedRun run;
  run.cost = 0.1;
  run.pacer.set_speed(0.0);
  run.advance_to(5.0);
  const Pacer::Plan plan = run.pacer.plan(run.now, run.wall, kLongest);
  EXPECT_EQ(plan.wait.count(), 0);
  EXPECT_NEAR(plan.slice.s(), 0.1, 0.06);
  run.cost = 1e-6;
  run.advance_to(50.0);
  EXPECT_EQ(run.pacer.plan(run.now, run.wall, kLongest).slice.ns, kLongest.ns);
}

}  // namespace
}  // namespace vinerow::live::pacer_test
