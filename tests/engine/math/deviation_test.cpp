#include "engine/math/deviation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/core/random.h"

namespace vinerow::deviation_test {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// MATLAB's findpeaks(y, 'MinPeakProminence', p), written down from its definition: a local maximum
/// (a plateau by its first sample), and its height above the higher of the two lowest values
/// between it and the nearest higher values (or the ends).
int count_by_definition(const std::vector<double>& y, double prominence) {
  const int n = static_cast<int>(y.size());
  int count = 0;
  for (int i = 1; i + 1 < n; ++i) {
    if (!(y[i] > y[i - 1])) continue;
    int end = i;
    while (end + 1 < n && y[end + 1] == y[i]) ++end;
    if (end + 1 >= n || y[end + 1] > y[i]) continue;
    double left = y[i], right = y[i];
    for (int j = i - 1; j >= 0 && y[j] <= y[i]; --j) left = std::min(left, y[j]);
    for (int j = end + 1; j < n && y[j] <= y[i]; ++j) right = std::min(right, y[j]);
    if (y[i] - std::max(left, right) >= prominence) ++count;
  }
  return count;
}

int count_streaming(const std::vector<double>& y, double prominence) {
  PeakCounter counter(prominence);
  for (const double value : y) counter.add(value);
  return static_cast<int>(counter.count());
}

TEST(PeakCounter, CountsPlateauOnceAndEndsNever) {
  EXPECT_EQ(count_streaming({0, 1, 1, 1, 0}, 0.0), 1);
  EXPECT_EQ(count_streaming({2, 1, 0}, 0.0), 0);
  EXPECT_EQ(count_streaming({0, 1, 2}, 0.0), 0);
  EXPECT_EQ(count_streaming({0, 1, 1}, 0.0), 0);
  EXPECT_EQ(count_streaming({0, 2, 1, 3, 0}, 0.0), 2);
}

TEST(PeakCounter, LeavesOutPeaksBelowTheProminence) {
  EXPECT_EQ(count_streaming({0, 2, 1.9, 3, 0}, 0.5), 1);
  EXPECT_EQ(count_streaming({0, 2, 1.4, 3, 0}, 0.5), 2);
}

TEST(PeakCounter, EqualsTheDefinitionOnRandomCurves) {
  RandomStream random(1, "test", "peaks");
  for (int curve = 0; curve < 500; ++curve) {
    // Few levels, so that plateaus are common; no two maxima of equal height decide the count with
    // prominence 0.
    std::vector<double> y;
    for (int i = 0; i < 60; ++i) y.push_back(std::floor(random.uniform(0.0, 8.0)));
    EXPECT_EQ(count_streaming(y, 0.0), count_by_definition(y, 0.0));
    // Continuous levels for the prominence: equal heights, where definitions differ, do not occur.
    for (double& value : y) value = random.uniform(0.0, 8.0);
    EXPECT_EQ(count_streaming(y, 0.0), count_by_definition(y, 0.0));
    EXPECT_EQ(count_streaming(y, 2.0), count_by_definition(y, 2.0));
  }
}

TEST(DeviationMeter, MeasuresASineAboutAStraight) {
  DeviationMeter meter({{0, 0}, {100, 0}});
  const int samples = 100001;
  for (int i = 0; i < samples; ++i) {
    const double x = 100.0 * i / (samples - 1);
    meter.add({x, 0.2 * std::sin(2.0 * M_PI * x / 10.0)});
  }
  // |sin| has the mean 2/pi and two maxima per period; 2e-6 covers the one sample
  // more than intervals, 1e-5 of the mean.
  EXPECT_NEAR(meter.average_m(), 0.2 * 2.0 / M_PI, 2e-6);
  EXPECT_NEAR(meter.max_m(), 0.2, 1e-6);
  EXPECT_EQ(meter.oscillations(), 20);
  EXPECT_NEAR(meter.relative_accuracy_per_m(), 1.0 / (20 * 0.4 / M_PI), 1e-5);
}

TEST(DeviationMeter, HasNoAccuracyWithoutDeviation) {
  DeviationMeter meter({{0, 0}, {10, 0}});
  EXPECT_TRUE(std::isnan(meter.average_m()));
  for (int i = 0; i < 10; ++i) meter.add({1.0 * i, 0.0});
  EXPECT_EQ(meter.oscillations(), 0);
  EXPECT_TRUE(std::isnan(meter.relative_accuracy_per_m()));
}

}  // namespace
}  // namespace vinerow::deviation_test
