#pragma once
/// Overlapping Allan deviation of a record, as IEEE Std 952-1997, annex C, defines it: written from
/// the definition, apart from what it judges.

#include <cmath>
#include <cstddef>
#include <vector>

namespace vinerow::test {

class AllanDeviation {
 public:
  /// @param record  rates at a constant period, any unit u
  AllanDeviation(const std::vector<double>& record, double period_s) : period_s_(period_s) {
    angle_.reserve(record.size() + 1);
    angle_.push_back(0.0);
    for (const double rate : record) angle_.push_back(angle_.back() + rate * period_s);
  }

  /// Mean square of second differences of the integral over n samples, u^2.
  double variance(std::size_t n) const {
    const double time_s = static_cast<double>(n) * period_s_;
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t k = 0; k + 2 * n < angle_.size(); ++k, ++count) {
      const double difference = angle_[k + 2 * n] - 2.0 * angle_[k + n] + angle_[k];
      sum += difference * difference;
    }
    return sum / (2.0 * time_s * time_s * static_cast<double>(count));
  }
  double deviation(std::size_t n) const { return std::sqrt(variance(n)); }

 private:
  double period_s_;
  std::vector<double> angle_;
};

}  // namespace vinerow::test
