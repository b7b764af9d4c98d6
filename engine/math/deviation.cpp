#include "engine/math/deviation.h"

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"

namespace vinerow {
namespace {
constexpr int kBlock = 32;      // segments per bounding box
constexpr int kHintWindow = 4;  // segments tried first on either side of the hint
}  // namespace

template <int kDimension>
PolylineDistanceIn<kDimension>::PolylineDistanceIn(std::vector<Point> points)
    : points_(std::move(points)) {
  VINEROW_DEMAND(!points_.empty());
  if (points_.size() == 1) points_.push_back(points_.front());
  blocks_.resize((points_.size() - 2) / kBlock + 1);
  for (int i = 0; i < segments(); ++i) {
    blocks_[i / kBlock].extend(points_[i]);
    blocks_[i / kBlock].extend(points_[i + 1]);
    length_m_ += (points_[i + 1] - points_[i]).norm();
  }
}

template <int kDimension>
void PolylineDistanceIn<kDimension>::try_segment(int segment, const Point& p, Nearest& best) const {
  const Point& a = points_[segment];
  const Point ab = points_[segment + 1] - a;
  const Point ap = p - a;
  const double length2 = ab.squaredNorm();
  const double fraction = length2 > 0.0 ? std::clamp(ap.dot(ab) / length2, 0.0, 1.0) : 0.0;
  const Point point = a + fraction * ab;
  const double distance = (p - point).norm();
  if (distance >= best.distance_m) return;
  const double cross = ab.x() * ap.y() - ab.y() * ap.x();
  best = {distance, std::copysign(distance, cross), segment, fraction, point};
}

template <int kDimension>
typename PolylineDistanceIn<kDimension>::Nearest PolylineDistanceIn<kDimension>::nearest_within(
    const Point& p, int first, int last) const {
  Nearest best;
  first = std::clamp(first, 0, segments() - 1);
  last = std::clamp(last, first, segments() - 1);
  for (int i = first; i <= last; ++i) try_segment(i, p, best);
  return best;
}

template <int kDimension>
typename PolylineDistanceIn<kDimension>::Nearest PolylineDistanceIn<kDimension>::nearest(
    const Point& p, int hint_segment) const {
  // First guess near the hint, then only the blocks whose box is nearer than the best so far.
  Nearest best = nearest_within(p, hint_segment - kHintWindow, hint_segment + kHintWindow);
  for (int block = 0; block < static_cast<int>(blocks_.size()); ++block) {
    const double reach = best.distance_m;
    if (blocks_[block].squaredExteriorDistance(p) >= reach * reach) continue;
    const int end = std::min((block + 1) * kBlock, segments());
    for (int i = block * kBlock; i < end; ++i) try_segment(i, p, best);
  }
  return best;
}

template class PolylineDistanceIn<2>;
template class PolylineDistanceIn<3>;

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

PolylineDistance::Nearest DeviationMeter::add(const Eigen::Vector2d& p) {
  const PolylineDistance::Nearest nearest = path_.nearest(p, segment_);
  segment_ = nearest.segment;
  DeviationStatistics::add(nearest.distance_m);
  return nearest;
}

}  // namespace vinerow
