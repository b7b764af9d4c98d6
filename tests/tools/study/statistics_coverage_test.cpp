/// How often intervals cover what they estimate, on simulated samples of known distributions.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/core/random.h"
#include "tools/study/statistics.h"

namespace vinerow::study::statistics_coverage_test {
namespace {

// Shares of intervals that lie below, around and above the truth.
struct Coverage {
  double below = 0.0, around = 0.0, above = 0.0;

  void add(Interval interval, double truth, double weight) {
    (interval.high < truth ? below : interval.low > truth ? above : around) += weight;
  }
};

std::vector<double> normal_sample(RandomStream& stream, int size) {
  std::vector<double> values;
  for (int i = 0; i < size; ++i) values.push_back(3.0 + 2.0 * stream.normal());
  return values;
}

// Mean 1, skewness 2.
std::vector<double> exponential_sample(RandomStream& stream, int size) {
  std::vector<double> values;
  for (int i = 0; i < size; ++i) values.push_back(-std::log(1.0 - stream.uniform()));
  return values;
}

TEST(Coverage, OfTheTIntervalIsNominal) {
  // 10000 samples of 5 normal values: exact in theory, standard error 0.0022. With the normal
  // quantile it would be 0.88, with n degrees of freedom 0.938, with divisor n 0.932.
  RandomStream stream(0, "test", "t_coverage");
  Coverage coverage;
  for (int i = 0; i < 10000; ++i) {
    coverage.add(t_interval(normal_sample(stream, 5), 0.95), 3.0, 1e-4);
  }
  EXPECT_NEAR(coverage.around, 0.95, 0.007);
  EXPECT_NEAR(coverage.below, 0.025, 0.005);
}

TEST(Coverage, OfTheBootstrapIntervalOfNormalValuesIsNearNominal) {
  // For symmetric values BCa tends to mean ± z √(Σ (x - mean)²) / n, which is short by √((n - 1) /
  // n) and by z for t: P(|T| < 1.645 √(29 / 30)) = 0.883 with 29 degrees of freedom. Standard error
  // 0.01.
  RandomStream stream(0, "test", "bootstrap_coverage");
  Coverage coverage;
  for (int i = 0; i < 1000; ++i) {
    coverage.add(bootstrap_interval(normal_sample(stream, 30), 0.9, 600), 3.0, 1e-3);
  }
  EXPECT_NEAR(coverage.around, 0.883, 0.025);
  EXPECT_NEAR(coverage.below, coverage.above, 0.025);
}

TEST(Coverage, OfTheBootstrapIntervalOfSkewedValuesIsMoreEvenThanThatOfT) {
  // Both miss in some 10 %. Of right-skewed values t misses mostly below the truth, BCa about as
  // often on either side.
  RandomStream stream(0, "test", "skewed_coverage");
  Coverage bootstrap, student;
  for (int i = 0; i < 1000; ++i) {
    const std::vector<double> values = exponential_sample(stream, 30);
    bootstrap.add(bootstrap_interval(values, 0.9, 600), 1.0, 1e-3);
    student.add(t_interval(values, 0.9), 1.0, 1e-3);
  }
  EXPECT_NEAR(bootstrap.around, 0.9, 0.025);
  EXPECT_GT(student.below, 3.0 * student.above);
  EXPECT_LT(bootstrap.below, 2.0 * bootstrap.above);
}

TEST(Coverage, OfWilsonsIntervalIsNominalOnAverage) {
  // No simulation: of n trials, each count k of successes has its binomial probability. The mean
  // over all p in (0, 1) lies a little above the nominal level (Agresti, Coull, "Approximate is
  // better than 'exact'", The American Statistician 52, 1998); that of p̂ ± z √(p̂ (1 - p̂) / n) is
  // 0.846 for 20 trials.
  for (const int trials : {5, 20, 50}) {
    Coverage mean;
    constexpr int kPlaces = 2000;
    for (int place = 0; place < kPlaces; ++place) {
      const double p = (place + 0.5) / kPlaces;
      double probability = std::pow(1.0 - p, trials);
      for (int k = 0; k <= trials; ++k) {
        mean.add(wilson_interval(k, trials, 0.95), p, probability / kPlaces);
        probability *= (trials - k) * p / ((k + 1) * (1.0 - p));
      }
    }
    EXPECT_NEAR(mean.around, 0.953, 0.003) << trials;
    EXPECT_NEAR(mean.below, mean.above, 1e-12) << trials;
    EXPECT_NEAR(mean.below + mean.around + mean.above, 1.0, 1e-12) << trials;
  }
}

TEST(Coverage, OfEqualSettingsAPairedTestRejectsAsOftenAsItSays) {
  // 4000 comparisons of 8 pairs without a difference: p values are uniform in [0, 1], standard
  // error at most 0.008.
  RandomStream stream(0, "test", "p_values");
  double below_5 = 0.0, below_50 = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const std::vector<double> a = normal_sample(stream, 8), b = normal_sample(stream, 8);
    const double p_value = paired_difference(a, b, 0.95).p_value;
    below_5 += p_value < 0.05 ? 1.0 / 4000.0 : 0.0;
    below_50 += p_value < 0.5 ? 1.0 / 4000.0 : 0.0;
  }
  EXPECT_NEAR(below_5, 0.05, 0.012);
  EXPECT_NEAR(below_50, 0.5, 0.025);
}

}  // namespace
}  // namespace vinerow::study::statistics_coverage_test
