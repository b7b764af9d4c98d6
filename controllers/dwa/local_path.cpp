#include "controllers/dwa/local_path.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {

void LocalPath::add(const Pose2& pose, double distance_m) {
  if (size_ == kCapacity) return;
  const int n = size_++;
  samples_[n] = {pose.p, direction(pose.yaw_rad), {0, 0}, pose.yaw_rad, distance_m};
  if (n == 0) return;
  // From the neighbours: a crabbing trace does not run along its headings.
  const int before = std::max(n - 2, 0);
  samples_[n - 1].along = (samples_[n].p - samples_[before].p).stableNormalized();
  samples_[n].along = (samples_[n].p - samples_[n - 1].p).stableNormalized();
}

int LocalPath::nearest(const Eigen::Vector2d& p, int hint) const {
  int i = std::clamp(hint, 0, size_ - 1);
  double best = (p - samples_[i].p).squaredNorm();
  const auto walk = [&](int step) {
    for (int k = i + step; k >= 0 && k < size_; k += step) {
      const double gap = (p - samples_[k].p).squaredNorm();
      if (gap > best) return;
      best = gap;
      i = k;
    }
  };
  walk(+1);
  walk(-1);
  return i;
}

double LocalPath::distance_m(const Eigen::Vector2d& p, int i) const {
  const Sample& sample = samples_[i];
  const Eigen::Vector2d offset = p - sample.p;
  const double ahead_m = sample.along.dot(offset);
  const bool is_beyond =
      size_ < 2 || (i == 0 && ahead_m < 0.0) || (i + 1 == size_ && ahead_m > 0.0);
  return is_beyond ? offset.norm() : std::abs(cross(sample.along, offset));
}

int LocalPath::index_at(double distance_m) const {
  for (int i = 0; i < size_; ++i) {
    if (samples_[i].distance_m >= distance_m) return i;
  }
  return size_ - 1;
}

void LocalPath::copy_moved(const LocalPath& from, double left_m) {
  size_ = from.size_;
  for (int i = 0; i < size_; ++i) {
    samples_[i] = from.samples_[i];
    samples_[i].p += left_m * left_of(samples_[i].ahead);
  }
}

}  // namespace vinerow::controllers
