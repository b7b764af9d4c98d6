#include "controllers/dwa/local_path.h"

#include <algorithm>
#include <cmath>

namespace vinerow {

void LocalPath::add(const Pose2& pose, double distance_m) {
  if (size_ == kCapacity) return;
  samples_[size_++] = {pose.p, direction(pose.yaw_rad), pose.yaw_rad, distance_m};
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
  const Eigen::Vector2d offset = p - samples_[i].p;
  if (i == 0 || i + 1 == size_) {
    // The trace backwards runs against its headings, so its neighbour tells which way is outwards.
    const int inner = i == 0 ? 1 : i - 1;
    const bool is_beyond = size_ < 2 || offset.dot(samples_[inner].p - samples_[i].p) < 0.0;
    if (is_beyond) return offset.norm();
  }
  // Across the way to the neighbours: a crabbing trace does not run along its headings.
  const Eigen::Vector2d along =
      samples_[std::min(i + 1, size_ - 1)].p - samples_[std::max(i - 1, 0)].p;
  const double length_m = along.norm();
  return length_m > 0.0 ? std::abs(cross(along, offset)) / length_m : offset.norm();
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

}  // namespace vinerow
