#pragma once
/// Statistics of one metric over the seeds of a setting, and of two settings over the same seeds.
///
/// Values are in the metric's unit, and so are means, deviations and intervals.
/// Which values count is the caller's decision: a metric that was not applicable, infinite or NaN
/// is left out before. Everywhere here: @pre all values are finite (a value that is not ends the
/// program, VINEROW_DEMAND), 0 < confidence < 1.
/// Cost: no hidden state, thread safe; the same input gives the same bits.

#include <cstddef>
#include <cstdint>
#include <span>

namespace vinerow::study {

/// From low to high, both included; infinite where nothing is known.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// What a sample looks like. NaN stands for what its count does not define.
struct Summary {
  std::size_t count = 0;
  double mean = 0.0;       ///< NaN without values
  double deviation = 0.0;  ///< sample standard deviation, divisor count - 1; NaN below 2 values
  double least = 0.0;      ///< NaN without values
  double greatest = 0.0;   ///< NaN without values
};

/// Mean and deviation are computed in two passes; equal values have exactly their mean and a
/// deviation of exactly 0.
Summary summarise(std::span<const double> values);

/// The value below which a share of the sample lies; between two values it interpolates.
///
/// Source: Hyndman, Fan, "Sample quantiles in statistical packages", The American Statistician 50
/// (1996), definition 7: at place h = (n - 1) share, counted from 0. As numpy and R do.
///
/// @param sorted  (n) at least one, ascending (both checked)
/// @param share   in [0, 1]; 0.5 is the median
double quantile(std::span<const double> sorted, double share);

/// Confidence interval of the mean: mean ± t s / √n, t the quantile (1 + confidence) / 2 of
/// Student's distribution with n - 1 degrees of freedom.
///
/// Source: Student, "The probable error of a mean", Biometrika 6 (1908). Exact for normal values,
/// good for others where n is not small or they are not skewed.
///
/// @param values  (n)
/// @returns the interval; (-infinity, infinity) with fewer than 2 values
Interval t_interval(std::span<const double> values, double confidence);

/// Confidence interval of the mean by the bootstrap, bias-corrected and accelerated (BCa): follows
/// the skewness of the values, where the t interval is symmetric.
///
/// Source: Efron, "Better bootstrap confidence intervals", JASA 82 (1987); Efron, Tibshirani, "An
/// introduction to the bootstrap" (1993), eq. 14.9 to 14.15.
///
/// Resamples are drawn from one fixed random stream: the same each time, and the same choice of
/// seeds for every metric with as many values.
///
/// The interval never leaves [least, greatest], so it is too short for few values: one of 95 %
/// covers the mean of 10 normal values in some 91 % of cases, of 5 in 83 %. There the t interval is
/// better.
///
/// @param values     (n)
/// @param resamples  at least 1 (checked); 2000 give the ends of a 95 % interval with a standard
///                   error of some 2 % of its length. Time grows with n * resamples
/// @returns the interval; (-infinity, infinity) with fewer than 2 values; [v, v] where all values
///          equal v
Interval bootstrap_interval(std::span<const double> values, double confidence,
                            std::size_t resamples = 2000);

/// Confidence interval of a probability, from independent trials (runs that succeeded). Always
/// within [0, 1], and of some width even where all or none succeeded.
///
/// Source: Wilson, "Probable inference, the law of succession, and statistical inference", JASA 22
/// (1927): the p with |p̂ - p| <= z √(p (1 - p) / n), without correction for continuity.
///
/// @pre 0 <= successes <= trials (checked)
/// @returns the interval; [0, 1] without trials
Interval wilson_interval(std::int64_t successes, std::int64_t trials, double confidence);

/// How much b lies above a, judged by the differences at the same seeds: what a seed does to both
/// alike cancels.
struct PairedDifference {
  std::size_t count = 0;   ///< pairs
  double mean = 0.0;       ///< of b - a; NaN without pairs
  double deviation = 0.0;  ///< of b - a, divisor count - 1; NaN below 2 pairs
  Interval interval;       ///< t interval of the mean difference; infinite below 2 pairs
  double p_value = 1.0;    ///< two-sided, of the hypothesis that the mean difference is 0; NaN
                           ///< below 2 pairs
};

/// Student's paired test: t = mean / (deviation / √n), n - 1 degrees of freedom. Differences that
/// are all equal have the p value 0, or 1 where they are 0.
///
/// The p value is of this one comparison: of twenty that show nothing, one is expected below 0.05.
///
/// @param a,b  (n) each, the same seed at the same place
/// @pre as many in a as in b (checked)
PairedDifference paired_difference(std::span<const double> a, std::span<const double> b,
                                   double confidence);

}  // namespace vinerow::study
