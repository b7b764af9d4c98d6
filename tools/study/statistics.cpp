#include "tools/study/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/core/check.h"
#include "engine/core/random.h"
#include "engine/math/statistics.h"
#include "tools/study/distributions.h"

namespace vinerow::study {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr Interval kEverything{-kInfinity, kInfinity};

bool is_share(double confidence) {
  return confidence > 0.0 && confidence < 1.0;
}

// Level of the normal distribution at which BCa takes its quantile (14.10 of the book):
// Φ(z0 + (z0 + z) / (1 - a (z0 + z))). Its limit is 0 or 1 if the denominator reaches 0.
double corrected_level(double z, double bias, double acceleration) {
  const double shifted = bias + z;
  const double denominator = 1.0 - acceleration * shifted;
  if (denominator <= 0.0) return shifted > 0.0 ? 1.0 : 0.0;
  return normal_probability(bias + shifted / denominator);
}

}  // namespace

Summary summarise(std::span<const double> values) {
  if (values.empty()) return {0, kUndefined, kUndefined, kUndefined, kUndefined};
  const double n = static_cast<double>(values.size());

  // Differences from the first value are small if the values are nearly equal, and exactly 0 if
  // they are equal.
  const double first = values.front();
  double sum = 0.0;
  for (const double value : values) {
    VINEROW_DEMAND(std::isfinite(value));
    sum += value - first;
  }
  Summary summary{values.size(), first + sum / n, kUndefined, first, first};
  for (const double value : values) {
    summary.minimum = std::min(summary.minimum, value);
    summary.maximum = std::max(summary.maximum, value);
  }
  if (values.size() < 2) return summary;

  // √(Σ (x - m)² / (n - 1)) in a second pass: Σ x² - n m² would cancel if m is large.
  double squares = 0.0;
  for (const double value : values) {
    const double difference = value - summary.mean;
    squares += difference * difference;
  }
  summary.deviation = std::sqrt(squares / (n - 1.0));
  return summary;
}

Interval t_interval(std::span<const double> values, double confidence) {
  VINEROW_DEMAND(is_share(confidence));
  const Summary summary = summarise(values);
  if (summary.count < 2) return kEverything;
  const double n = static_cast<double>(summary.count);
  // The lower quantile, because 1 - confidence is exact for a confidence near 1.
  const double t = -student_quantile(0.5 * (1.0 - confidence), n - 1.0);
  const double half = t * summary.deviation / std::sqrt(n);
  return {summary.mean - half, summary.mean + half};
}

Interval bootstrap_interval(std::span<const double> values, double confidence,
                            std::size_t resamples) {
  VINEROW_DEMAND(is_share(confidence) && resamples > 0);
  const Summary summary = summarise(values);
  if (summary.count < 2) return kEverything;
  if (summary.minimum == summary.maximum) return {summary.minimum, summary.minimum};
  const double n = static_cast<double>(summary.count);

  // Deviations from the mean, relative to the largest: their cubes neither overflow nor vanish.
  const double scale = std::max(summary.maximum - summary.mean, summary.mean - summary.minimum);
  std::vector<double> deviations;
  for (const double value : values) deviations.push_back((value - summary.mean) / scale);

  // Means of resamples, drawn with replacement, relative to the sample's mean. A draw is below 1,
  // so n times it rounds to less than n.
  RandomStream stream(0, "study", "bootstrap");
  std::vector<double> means(resamples);
  for (double& mean : means) {
    double sum = 0.0;
    for (std::size_t draw = 0; draw < deviations.size(); ++draw) {
      sum += deviations[static_cast<std::size_t>(n * stream.uniform())];
    }
    mean = sum / n;
  }
  std::sort(means.begin(), means.end());

  // Bias z0 = Φ⁻¹(share of resampled means below the sample's), 14.14 of the book. Ties count half,
  // since means of few or repeated values often equal the sample's, but for rounding. Half a
  // resample at each end keeps z0 finite.
  constexpr double kTie = 1e-9;
  const auto first_tie = std::lower_bound(means.begin(), means.end(), -kTie);
  const auto after_ties = std::upper_bound(means.begin(), means.end(), kTie);
  const double below =
      0.5 * static_cast<double>((first_tie - means.begin()) + (after_ties - means.begin()));
  const double count = static_cast<double>(resamples);
  const double bias = normal_quantile(std::clamp(below, 0.5, count - 0.5) / count);

  // Acceleration a = Σ u³ / (6 (Σ u²)^(3/2)), 14.15 of the book, with the jackknife's
  // u_i = mean of all - mean without i = (x_i - mean) / (n - 1); the divisor cancels.
  double squares = 0.0, cubes = 0.0;
  for (const double u : deviations) {
    squares += u * u;
    cubes += u * u * u;
  }
  const double acceleration = cubes / (6.0 * squares * std::sqrt(squares));

  const double z = normal_quantile(0.5 * (1.0 - confidence));
  const double low = quantile(means, corrected_level(z, bias, acceleration));
  const double high = quantile(means, corrected_level(-z, bias, acceleration));
  return {std::max(summary.minimum, summary.mean + scale * low),
          std::min(summary.maximum, summary.mean + scale * high)};
}

Interval wilson_interval(std::int64_t successes, std::int64_t trials, double confidence) {
  VINEROW_DEMAND(is_share(confidence) && successes >= 0 && successes <= trials);
  if (trials == 0) return {0.0, 1.0};
  const double n = static_cast<double>(trials), k = static_cast<double>(successes);
  const double z = normal_quantile(0.5 * (1.0 - confidence)), z2 = z * z;
  // Roots p of (k/n - p)² = z² p (1 - p) / n.
  const double centre = (k + 0.5 * z2) / (n + z2);
  const double half = std::sqrt(z2 * (k * (n - k) / n + 0.25 * z2)) / (n + z2);
  // One root is 0 or 1 if none or all succeeded; rounding keeps the 0 but may miss the 1.
  return {std::max(0.0, centre - half), successes == trials ? 1.0 : std::min(1.0, centre + half)};
}

PairedDifference paired_difference(std::span<const double> a, std::span<const double> b,
                                   double confidence) {
  VINEROW_DEMAND(a.size() == b.size());
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(b[i] - a[i]);
  const Summary summary = summarise(differences);
  PairedDifference result{summary.count, summary.mean, summary.deviation,
                          t_interval(differences, confidence), kUndefined};
  if (summary.count < 2) return result;

  // Without deviation t is infinite, or undefined if the mean is 0 too.
  if (summary.mean == 0.0) {
    result.p_value = 1.0;
  } else {
    const double n = static_cast<double>(summary.count);
    result.p_value = student_two_sided(summary.mean / (summary.deviation / std::sqrt(n)), n - 1.0);
  }
  return result;
}

}  // namespace vinerow::study
