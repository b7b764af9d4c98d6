#pragma once
/// The next metres to drive as a short list of poses for the comparison with rollouts: the plan,
/// the plan moved sideways, or the vehicle's own trace backwards. Fixed capacity.

#include <array>

#include "controllers/parts/paths/pose2.h"

namespace vinerow::controllers {

class LocalPath {
 public:
  static constexpr int kCapacity = 96;

  struct Sample {
    Eigen::Vector2d p = Eigen::Vector2d::Zero();
    Eigen::Vector2d ahead = Eigen::Vector2d::UnitX();  ///< heading of the vehicle there
    Eigen::Vector2d along = Eigen::Vector2d::Zero();   ///< unit vector of the path, 0 if alone
    double yaw_rad = 0.0;
    double distance_m = 0.0;  ///< along the path, from any origin
  };

  void clear() { size_ = 0; }
  int size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// Ignored beyond the capacity. @pre poses differ in position
  void add(const Pose2& pose, double distance_m);
  const Sample& operator[](int i) const { return samples_[i]; }
  const Sample& last() const { return samples_[size_ - 1]; }

  /// Index of the nearest sample, walking downhill from `hint`. @pre !empty()
  int nearest(const Eigen::Vector2d& p, int hint) const;
  /// Distance of a point from the path near sample `i`: across it; beyond an end, from that end.
  double distance_m(const Eigen::Vector2d& p, int i) const;
  /// First sample at or beyond a distance, or the last sample.
  int index_at(double distance_m) const;

  /// The same path moved to the left.
  void copy_moved(const LocalPath& from, double left_m);

 private:
  std::array<Sample, kCapacity> samples_;
  int size_ = 0;
};

}  // namespace vinerow::controllers
