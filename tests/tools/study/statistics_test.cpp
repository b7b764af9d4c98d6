/// Summaries, quantiles, intervals and paired differences against published examples and scipy.

#include "engine/math/statistics.h"
#include "tools/study/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/core/random.h"

namespace vinerow::study::statistics_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void expect_interval(Interval interval, double low, double high, double tolerance) {
  EXPECT_NEAR(interval.low, low, tolerance);
  EXPECT_NEAR(interval.high, high, tolerance);
}

void expect_everything(Interval interval) {
  EXPECT_EQ(interval.low, -kInfinity);
  EXPECT_EQ(interval.high, kInfinity);
}

// Hours of sleep gained by two drugs, the same ten patients (Student 1908).
const std::vector<double> kSleep1{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
const std::vector<double> kSleep2{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

// A skewed sample, for which BCa and other intervals differ.
const std::vector<double> kSkewed{0.14, 0.22, 0.31, 0.35, 0.48, 0.53, 0.67, 0.74,
                                  0.91, 1.02, 1.31, 1.48, 1.77, 2.36, 4.85};

TEST(Summary, OfAFewNumbers) {
  // Mean 5, squares of differences 9 + 1 + 1 + 1 + 0 + 0 + 4 + 16 = 32.
  const Summary summary = summarise(std::vector<double>{2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_EQ(summary.count, 8u);
  EXPECT_DOUBLE_EQ(summary.mean, 5.0);
  EXPECT_DOUBLE_EQ(summary.deviation, std::sqrt(32.0 / 7.0));
  EXPECT_EQ(summary.minimum, 2.0);
  EXPECT_EQ(summary.maximum, 9.0);
}

TEST(Summary, SurvivesALargeMean) {
  // NumAcc4 of NIST's Statistical Reference Datasets: certified mean 10000000.2, deviation 0.1.
  // Values near 1e7 are rounded to 2e-9, which is 2e-8 of the deviation.
  std::vector<double> values{10000000.2};
  for (int i = 0; i < 500; ++i) values.insert(values.end(), {10000000.1, 10000000.3});
  const Summary summary = summarise(values);
  EXPECT_NEAR(summary.mean, 10000000.2, 2e-9);
  EXPECT_NEAR(summary.deviation, 0.1, 1e-8);
}

TEST(Summary, OfEqualValuesIsExact) {
  const Summary summary = summarise(std::vector<double>(7, 0.1));
  EXPECT_EQ(summary.mean, 0.1);
  EXPECT_EQ(summary.deviation, 0.0);
}

TEST(Summary, SaysWhatTooFewValuesDoNotDefine) {
  const Summary none = summarise({});
  EXPECT_EQ(none.count, 0u);
  EXPECT_TRUE(std::isnan(none.mean) && std::isnan(none.deviation));
  EXPECT_TRUE(std::isnan(none.minimum) && std::isnan(none.maximum));
  const Summary one = summarise(std::vector<double>{-3.5});
  EXPECT_EQ(one.mean, -3.5);
  EXPECT_TRUE(std::isnan(one.deviation));
  EXPECT_EQ(one.minimum, -3.5);
  EXPECT_EQ(one.maximum, -3.5);
}

TEST(Quantile, IsThatOfNumpy) {
  // numpy.quantile([3, 1, 4, 1, 5, 9, 2, 6], [0, 0.1, 0.25, 0.5, 0.9, 1])
  const std::vector<double> sorted{1, 1, 2, 3, 4, 5, 6, 9};
  EXPECT_EQ(quantile(sorted, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile(sorted, 0.1), 1.0);
  EXPECT_DOUBLE_EQ(quantile(sorted, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(quantile(sorted, 0.5), 3.5);
  EXPECT_DOUBLE_EQ(quantile(sorted, 0.9), 6.9);
  EXPECT_EQ(quantile(sorted, 1.0), 9.0);
  EXPECT_EQ(quantile(std::array{2.5}, 0.3), 2.5);
}

TEST(TInterval, IsThatOfMpmath) {
  // With the quantile of distributions_test. To nine digits scipy.stats.t.interval(0.95, 14,
  // numpy.mean(x), scipy.stats.sem(x)).
  expect_interval(t_interval(kSkewed, 0.95), 0.47732017242566396, 1.8080131609076694, 1e-14);
}

TEST(TInterval, OfTwoValuesFollowsCauchysDistribution) {
  // Mean 1 and s / √2 = 1; with 0.1 left on each side t = tan(π (0.9 - 0.5)).
  const double t = std::tan(0.4 * std::numbers::pi);
  expect_interval(t_interval(std::array{0.0, 2.0}, 0.8), 1.0 - t, 1.0 + t, 1e-13);
}

TEST(TInterval, OfFewerThanTwoValuesIsInfinite) {
  expect_everything(t_interval({}, 0.95));
  expect_everything(t_interval(std::array{1.0}, 0.95));
  expect_interval(t_interval(std::array{0.1, 0.1, 0.1}, 0.95), 0.1, 0.1, 0.0);
}

TEST(BootstrapInterval, IsThatOfScipy) {
  // scipy.stats.bootstrap((x,), numpy.mean, confidence_level=0.95 or 0.8, n_resamples=400000,
  // method='BCa', random_state=1). The ends scatter by 0.004 between streams; the percentile
  // interval is (0.648, 1.801), so one without corrections is out by ten times the tolerance.
  expect_interval(bootstrap_interval(kSkewed, 0.95, 100000), 0.7313, 2.062, 0.02);
  expect_interval(bootstrap_interval(kSkewed, 0.8, 100000), 0.8460, 1.6860, 0.01);
  // Survival of mice, days (Efron, Tibshirani 1993, table 2.1); means are multiples of 1/7.
  const std::vector<double> mice{94, 197, 16, 38, 99, 141, 23};
  expect_interval(bootstrap_interval(mice, 0.9, 100000), 52.29, 130.29, 0.6);
}

TEST(BootstrapInterval, IsTheSameEachTime) {
  const Interval once = bootstrap_interval(kSkewed, 0.95),
                 again = bootstrap_interval(kSkewed, 0.95);
  EXPECT_EQ(once.low, again.low);
  EXPECT_EQ(once.high, again.high);
}

TEST(BootstrapInterval, FollowsShiftScaleAndMirror) {
  const Interval plain = bootstrap_interval(kSkewed, 0.9);
  std::vector<double> changed;
  for (const double value : kSkewed) changed.push_back(5.0 - 1e-6 * value);
  const Interval mirrored = bootstrap_interval(changed, 0.9);
  expect_interval(mirrored, 5.0 - 1e-6 * plain.high, 5.0 - 1e-6 * plain.low, 1e-14);
}

TEST(BootstrapInterval, TakesExtremeMagnitudes) {
  const Interval plain = bootstrap_interval(kSkewed, 0.9);
  for (const double scale : {1e-200, 1e200}) {
    std::vector<double> scaled;
    for (const double value : kSkewed) scaled.push_back(scale * value);
    const Interval interval = bootstrap_interval(scaled, 0.9);
    EXPECT_NEAR(interval.low / scale, plain.low, 1e-12);
    EXPECT_NEAR(interval.high / scale, plain.high, 1e-12);
  }
}

TEST(BootstrapInterval, StaysWithinTheSample) {
  for (const std::size_t resamples : {1u, 2u, 50u}) {
    for (const double confidence : {0.5, 0.99, 1.0 - 1e-15}) {
      const Interval interval = bootstrap_interval(kSkewed, confidence, resamples);
      EXPECT_LE(kSkewed.front(), interval.low);
      EXPECT_LE(interval.low, interval.high);
      EXPECT_LE(interval.high, kSkewed.back());
    }
  }
  // A quarter of the resampled means of two values lies on each of them.
  expect_interval(bootstrap_interval(std::array{1.0, 3.0}, 0.95), 1.0, 3.0, 0.0);
}

TEST(BootstrapInterval, OfFewOrEqualValues) {
  expect_everything(bootstrap_interval({}, 0.95));
  expect_everything(bootstrap_interval(std::array{1.0}, 0.95));
  expect_interval(bootstrap_interval(std::array{0.1, 0.1, 0.1}, 0.95), 0.1, 0.1, 0.0);
}

TEST(WilsonInterval, IsThatOfNewcombe) {
  // Newcombe, "Two-sided confidence intervals for the single proportion", Statistics in Medicine 17
  // (1998), table I, method 3: to four digits there, here as by
  // scipy.stats.binomtest(k, n).proportion_ci(0.95, 'wilson').
  expect_interval(wilson_interval(81, 263, 0.95), 0.2552885198782742, 0.36620957698280004, 1e-14);
  expect_interval(wilson_interval(15, 148, 0.95), 0.06238639953073629, 0.16048724172330803, 1e-14);
  expect_interval(wilson_interval(0, 20, 0.95), 0.0, 0.16112515805281935, 1e-14);
  expect_interval(wilson_interval(1, 29, 0.95), 0.006113214292762667, 0.17175521879320282, 1e-14);
  expect_interval(wilson_interval(20, 20, 0.99), 0.7508945989012464, 1.0, 1e-14);
}

TEST(WilsonInterval, EndsExactlyAtZeroAndOne) {
  for (int trials = 1; trials < 200; ++trials) {
    EXPECT_EQ(wilson_interval(0, trials, 0.95).low, 0.0);
    EXPECT_LT(wilson_interval(0, trials, 0.95).high, 1.0);
    EXPECT_EQ(wilson_interval(trials, trials, 0.95).high, 1.0);
    EXPECT_GT(wilson_interval(trials, trials, 0.95).low, 0.0);
  }
  expect_interval(wilson_interval(0, 0, 0.95), 0.0, 1.0, 0.0);
}

TEST(PairedDifference, IsThatOfStudentsSleepData) {
  // scipy.stats.ttest_rel(drug2, drug1); its confidence intervals with mpmath's quantiles. The
  // manual of R's t.test shows the same numbers.
  const PairedDifference difference = paired_difference(kSleep1, kSleep2, 0.95);
  EXPECT_EQ(difference.count, 10u);
  EXPECT_NEAR(difference.mean, 1.58, 1e-14);
  EXPECT_NEAR(difference.deviation, 1.2299954832798732, 1e-13);
  expect_interval(difference.interval, 0.7001142367230172, 2.4598857632769828, 1e-14);
  EXPECT_NEAR(difference.p_value, 0.00283289019738427, 1e-14);
  expect_interval(paired_difference(kSleep1, kSleep2, 0.9).interval, 0.86699473297071618,
                  2.2930052670292838, 1e-14);
}

TEST(PairedDifference, ChangesItsSignWithTheOrder) {
  const PairedDifference there = paired_difference(kSleep1, kSleep2, 0.95);
  const PairedDifference back = paired_difference(kSleep2, kSleep1, 0.95);
  EXPECT_DOUBLE_EQ(back.mean, -there.mean);
  EXPECT_DOUBLE_EQ(back.interval.low, -there.interval.high);
  EXPECT_DOUBLE_EQ(back.interval.high, -there.interval.low);
  EXPECT_DOUBLE_EQ(back.p_value, there.p_value);
}

TEST(PairedDifference, IsBlindToWhatASeedDoesToBoth) {
  // Noise of a seed with deviation 10, differences of 0.3 with deviation 0.1 √2.
  RandomStream stream(0, "test", "paired");
  std::vector<double> a, b;
  for (int seed = 0; seed < 20; ++seed) {
    const double shared = 10.0 * stream.normal();
    const double own_a = 0.1 * stream.normal(), own_b = 0.1 * stream.normal();
    a.push_back(shared + own_a);
    b.push_back(shared + own_b + 0.3);
  }
  const PairedDifference difference = paired_difference(a, b, 0.95);
  // Chi-square bounds (99.9 %) of a deviation from 20 values: 0.52 and 1.54 times the true one.
  EXPECT_NEAR(difference.deviation, 0.141, 0.076);
  EXPECT_LT(difference.interval.low, 0.3);
  EXPECT_GT(difference.interval.high, 0.3);
  EXPECT_LT(difference.p_value, 1e-5);
  EXPECT_GT(t_interval(a, 0.95).high - t_interval(a, 0.95).low, 5.0) << "each alone shows nothing";
}

TEST(PairedDifference, RejectsWhereItsIntervalLeavesZeroOut) {
  RandomStream stream(0, "test", "duality");
  int rejected = 0;
  for (int sample = 0; sample < 200; ++sample) {
    std::vector<double> a, b;
    for (int seed = 0; seed < 6; ++seed) {
      a.push_back(stream.normal());
      b.push_back(stream.normal() + 1.0);
    }
    const PairedDifference difference = paired_difference(a, b, 0.9);
    const bool outside = difference.interval.low > 0.0 || difference.interval.high < 0.0;
    EXPECT_EQ(difference.p_value < 0.1, outside);
    rejected += outside ? 1 : 0;
  }
  EXPECT_GT(rejected, 40);
  EXPECT_LT(rejected, 160);
}

TEST(PairedDifference, OfFewOrEqualDifferences) {
  const PairedDifference none = paired_difference({}, {}, 0.95);
  EXPECT_EQ(none.count, 0u);
  EXPECT_TRUE(std::isnan(none.mean) && std::isnan(none.p_value));
  const PairedDifference one = paired_difference(std::array{1.0}, std::array{3.0}, 0.95);
  EXPECT_EQ(one.mean, 2.0);
  EXPECT_TRUE(std::isnan(one.deviation) && std::isnan(one.p_value));
  expect_everything(one.interval);

  const std::array<double, 3> a{1.0, 2.0, 3.0}, b{1.5, 2.5, 3.5};
  EXPECT_EQ(paired_difference(a, a, 0.95).p_value, 1.0);
  EXPECT_EQ(paired_difference(a, b, 0.95).p_value, 0.0);
  expect_interval(paired_difference(a, b, 0.95).interval, 0.5, 0.5, 0.0);
}

TEST(StatisticsDeathTest, RefusesWhatItDoesNotTake) {
  const std::array<double, 2> good{1.0, 2.0}, infinite{1.0, kInfinity}, nan{kNaN, 1.0};
  EXPECT_DEATH(summarise(infinite), "check failed");
  EXPECT_DEATH(summarise(nan), "check failed");
  EXPECT_DEATH(t_interval(nan, 0.95), "check failed");
  EXPECT_DEATH(t_interval(good, 95.0), "check failed");
  EXPECT_DEATH(t_interval(good, 0.0), "check failed");
  EXPECT_DEATH(bootstrap_interval(infinite, 0.95), "check failed");
  EXPECT_DEATH(bootstrap_interval(good, 1.0), "check failed");
  EXPECT_DEATH(bootstrap_interval(good, 0.95, 0), "check failed");
  EXPECT_DEATH(wilson_interval(3, 2, 0.95), "check failed");
  EXPECT_DEATH(wilson_interval(-1, 2, 0.95), "check failed");
  EXPECT_DEATH(wilson_interval(1, 2, kNaN), "check failed");
  EXPECT_DEATH(paired_difference(good, std::array{1.0}, 0.95), "check failed");
  EXPECT_DEATH(paired_difference(infinite, infinite, 0.95), "check failed");
  EXPECT_DEATH(quantile({}, 0.5), "check failed");
  EXPECT_DEATH(quantile(good, 1.1), "check failed");
  EXPECT_DEATH(quantile(std::array{2.0, 1.0}, 0.5), "check failed");
}

}  // namespace
}  // namespace vinerow::study::statistics_test
