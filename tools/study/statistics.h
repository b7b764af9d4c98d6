#pragma once
/// Statistics of one metric over the seeds of a setting, and of two settings over the same seeds.
///
/// Means, deviations and intervals have the metric's unit.
/// The caller selects the values and leaves out those that are not applicable, infinite or NaN.
/// For all functions: @pre all values are finite (otherwise VINEROW_DEMAND ends the program),
/// 0 < confidence < 1.
/// No hidden state, thread safe; the same input gives the same bits.

#include <cstddef>
#include <cstdint>
#include <span>

namespace vinerow::study {

/// Closed interval; infinite if nothing is known.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Summary of a sample. NaN marks values that its count does not define.
struct Summary {
  std::size_t count = 0;
  double mean = 0.0;       ///< NaN without values
  double deviation = 0.0;  ///< sample standard deviation, divisor count - 1; NaN below 2 values
  double minimum = 0.0;    ///< NaN without values
  double maximum = 0.0;    ///< NaN without values
};

/// Computes mean and deviation in two passes; equal values give exactly that mean and a deviation
/// of exactly 0.
Summary summarise(std::span<const double> values);

/// Confidence interval of the mean: mean ± t s / √n, t the quantile (1 + confidence) / 2 of
/// Student's distribution with n - 1 degrees of freedom.
///
/// Source: Student, "The probable error of a mean", Biometrika 6 (1908). Exact for normal values,
/// good for others if n is not small or they are not skewed.
///
/// @param values  (n)
/// @returns the interval; (-infinity, infinity) with fewer than 2 values
Interval t_interval(std::span<const double> values, double confidence);

/// Bootstrap confidence interval of the mean, bias-corrected and accelerated (BCa). It follows the
/// skewness of the values; the t interval is symmetric.
///
/// Source: Efron, "Better bootstrap confidence intervals", JASA 82 (1987); Efron, Tibshirani, "An
/// introduction to the bootstrap" (1993), eq. 14.9 to 14.15.
///
/// Resamples are drawn from one fixed random stream: the same each time, and the same selection for
/// every metric with equally many values.
///
/// The interval never leaves [minimum, maximum], so it is too short for few values: a 95 % interval
/// covers the mean of 10 normal values in about 91 % of cases, of 5 in 83 %. For few values the t
/// interval is better.
///
/// @param values     (n)
/// @param resamples  at least 1 (checked); 2000 give the ends of a 95 % interval with a standard
///                   error of about 2 % of its length. Time grows with n * resamples
/// @returns the interval; (-infinity, infinity) with fewer than 2 values; [v, v] if all values
/// equal v
Interval bootstrap_interval(std::span<const double> values, double confidence,
                            std::size_t resamples = 2000);

/// Confidence interval of a probability from independent trials (runs that succeeded). It is always
/// within [0, 1], and has a width even if all or none succeeded.
///
/// Source: Wilson, "Probable inference, the law of succession, and statistical inference", JASA 22
/// (1927): all p with |p̂ - p| <= z √(p (1 - p) / n), without continuity correction.
///
/// @pre 0 <= successes <= trials (checked)
/// @returns the interval; [0, 1] without trials
Interval wilson_interval(std::int64_t successes, std::int64_t trials, double confidence);

/// Difference b - a at the same seeds: effects of a seed on both cancel.
struct PairedDifference {
  std::size_t count = 0;   ///< pairs
  double mean = 0.0;       ///< mean of b - a; NaN without pairs
  double deviation = 0.0;  ///< deviation of b - a, divisor count - 1; NaN below 2 pairs
  Interval interval;       ///< t interval of the mean difference; infinite below 2 pairs
  double p_value = 1.0;    ///< two-sided, of the hypothesis that the mean difference is 0; NaN
                           ///< below 2 pairs
};

/// Student's paired test: t = mean / (deviation / √n), n - 1 degrees of freedom. If all differences
/// are equal the p value is 0, or 1 if they are 0.
///
/// The p value is for a single comparison: of twenty without any effect, one is expected below
/// 0.05.
///
/// @param a,b  (n) each, the same seed at the same index
/// @pre a and b have equal sizes (checked)
PairedDifference paired_difference(std::span<const double> a, std::span<const double> b,
                                   double confidence);

}  // namespace vinerow::study
