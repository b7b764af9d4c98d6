#pragma once
/// Ray against boxes with axes along the coordinates, by slabs.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

namespace vinerow::physics {

/// A ray against boxes. They are wider than what they contain by more than the rounding here.
class BoxRay {
 public:
  BoxRay(const Eigen::Vector3d& p, const Eigen::Vector3d& dir)
      : p_(p), dir_(dir), per_dir_(dir.cwiseInverse()) {}

  /// Distance at which the ray enters the box, 0 inside; nullopt if it misses the box or ends
  /// before.
  std::optional<double> enter_m(const Eigen::AlignedBox3d& box, double max_distance_m) const {
    if (box.contains(p_)) return 0.0;
    double first_m = 0.0, last_m = max_distance_m;
    for (int axis = 0; axis < 3; ++axis) {
      if (dir_[axis] == 0.0) {
        if (p_[axis] < box.min()[axis] || p_[axis] > box.max()[axis]) return std::nullopt;
        continue;
      }
      const double low_m = (box.min()[axis] - p_[axis]) * per_dir_[axis];
      const double high_m = (box.max()[axis] - p_[axis]) * per_dir_[axis];
      first_m = std::max(first_m, std::min(low_m, high_m));
      last_m = std::min(last_m, std::max(low_m, high_m));
    }
    if (!(first_m <= last_m)) return std::nullopt;
    return first_m;
  }

 private:
  Eigen::Vector3d p_, dir_, per_dir_;
};

}  // namespace vinerow::physics
