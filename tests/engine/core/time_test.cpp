#include "engine/core/time.h"

#include <gtest/gtest.h>

namespace vinerow::time_test {
namespace {

TEST(Time, RatesOfSensorsHaveExactPeriods) {
  EXPECT_EQ(period_of_rate(5.0).ns, 200'000'000);
  EXPECT_EQ(period_of_rate(20.0).ns, 50'000'000);
  EXPECT_EQ(period_of_rate(100.0).ns, 10'000'000);
  EXPECT_EQ(period_of_rate(40.0).ns, 25'000'000);
}

TEST(Time, SecondsRoundToTheNearestNanosecond) {
  EXPECT_EQ(duration_from_s(0.001).ns, 1'000'000);
  EXPECT_EQ(duration_from_s(3600.0).ns, 3'600'000'000'000);
  EXPECT_EQ(duration_from_s(-0.1).ns, -100'000'000);
}

TEST(Time, DifferencesOfTimesAreDurations) {
  const Time start{500}, end{700};
  EXPECT_EQ((end - start).ns, 200);
  EXPECT_EQ((start + Duration{200}), end);
  EXPECT_LT(start, end);
}

TEST(Time, NearestSecondsPrintAsTheirDecimal) {
  const Time time{84'800'000'000};
  EXPECT_EQ(time.nearest_s(), 84.8);
  EXPECT_EQ((time - Time{}).nearest_s(), 84.8);
  EXPECT_NE(time.s(), 84.8);
}

}  // namespace
}  // namespace vinerow::time_test
