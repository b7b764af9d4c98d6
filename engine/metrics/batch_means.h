#pragma once
/// Mean of a correlated series, and its effective sample size.
///
/// Method of batch means (C. Alexopoulos, A. Seila, "Output data analysis", in Handbook of
/// Simulation, ed. J. Banks, 1998): the ratio of the variance of long batches' means to that of the
/// samples estimates the integrated autocorrelation. With m batches, sample variance s^2 and
/// variance b^2 of the batch means, the effective sample size is m s^2 / b^2. Memory is fixed:
/// batches are joined in pairs when they become too many.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace vinerow::metrics {

class BatchMeans {
 public:
  void add(double value) {
    ++count_;
    sum_ += value;
    squares_ += value * value;
    batch_sum_ += value;
    if (++in_batch_ < batch_length_) return;
    batches_[batch_count_++] = batch_sum_ / static_cast<double>(batch_length_);
    batch_sum_ = 0.0;
    in_batch_ = 0;
    if (batch_count_ == kBatches) join_pairs();
  }

  std::int64_t count() const { return count_; }
  double mean() const {
    return count_ > 0 ? sum_ / static_cast<double>(count_)
                      : std::numeric_limits<double>::quiet_NaN();
  }
  /// Effective sample size: number of independent samples with an equally precise mean, >= 1. NaN
  /// with fewer than 16 batches.
  double independent_count() const {
    if (batch_count_ < kBatches / 2) return std::numeric_limits<double>::quiet_NaN();
    const double n = static_cast<double>(count_), m = static_cast<double>(batch_count_);
    const double variance = std::max(0.0, squares_ / n - mean() * mean());
    double batch_mean = 0.0, batch_variance = 0.0;
    for (int i = 0; i < batch_count_; ++i) batch_mean += batches_[i] / m;
    for (int i = 0; i < batch_count_; ++i) {
      batch_variance += (batches_[i] - batch_mean) * (batches_[i] - batch_mean) / (m - 1.0);
    }
    // A constant series counts as one sample.
    if (!(variance > 0.0)) return 1.0;
    if (!(batch_variance > 0.0)) return n;
    return std::clamp(m * variance / batch_variance, 1.0, n);
  }

 private:
  static constexpr int kBatches = 32;
  void join_pairs() {
    for (int i = 0; i < kBatches / 2; ++i) {
      batches_[i] = 0.5 * (batches_[2 * i] + batches_[2 * i + 1]);
    }
    batch_count_ = kBatches / 2;
    batch_length_ *= 2;
  }

  std::int64_t count_ = 0;
  double sum_ = 0.0, squares_ = 0.0;
  std::array<double, kBatches> batches_{};
  int batch_count_ = 0;
  std::int64_t batch_length_ = 1;
  std::int64_t in_batch_ = 0;
  double batch_sum_ = 0.0;
};

}  // namespace vinerow::metrics
