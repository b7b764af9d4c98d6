#include "engine/math/deviation.h"

#include <algorithm>

namespace vinerow {

void PeakCounter::add(double value) {
  const auto is_step = [this](double change) { return change > 0.0 && change >= min_prominence_; };
  if (!rising_) {
    low_ = std::min(low_, value);
    if (is_step(value - low_)) {
      rising_ = true;
      high_ = value;
    }
    return;
  }
  high_ = std::max(high_, value);
  if (is_step(high_ - value)) {
    ++count_;
    rising_ = false;
    low_ = value;
  }
}

void DeviationStatistics::add(double distance_m) {
  ++samples_;
  sum_m_ += distance_m;
  max_m_ = std::max(max_m_, distance_m);
  peaks_.add(distance_m);
}

double DeviationStatistics::average_m() const {
  return samples_ > 0 ? sum_m_ / static_cast<double>(samples_)
                      : std::numeric_limits<double>::quiet_NaN();
}

double DeviationStatistics::relative_accuracy_per_m() const {
  const double product = average_m() * static_cast<double>(oscillations());
  return product > 0.0 ? 1.0 / product : std::numeric_limits<double>::quiet_NaN();
}

Polyline::Nearest DeviationMeter::add(const Eigen::Vector2d& p) {
  const Polyline::Nearest nearest = path_.nearest(p, segment_);
  segment_ = nearest.segment;
  DeviationStatistics::add(nearest.distance_m);
  return nearest;
}

}  // namespace vinerow
