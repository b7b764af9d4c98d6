#pragma once
/// How near vehicles come to each other: the least true distance between their boxes, over a run.

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "engine/core/time.h"
#include "engine/math/pose.h"

namespace vinerow {

class Separation {
 public:
  /// The nearest that two vehicles came.
  struct Least {
    double distance_m = std::numeric_limits<double>::infinity();  ///< 0: touched or overlapped
    int other = -1;  ///< vehicle that was there, -1: none was ever beside it
    Time time;       ///< when first so near
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< centre of this vehicle's box then
  };

  /// @param vehicles  how many, at least 1
  explicit Separation(int vehicles);

  int vehicles() const { return static_cast<int>(boxes_.size()); }
  /// Where a vehicle's box is now. @param X_WB  pose of the vehicle  @param centre_B  of the box
  /// @param half_extents_m  along the axes of B
  void place(int vehicle, const Pose& X_WB, const Eigen::Vector3d& centre_B,
             const Eigen::Vector3d& half_extents_m);
  /// A vehicle that is not there any more, or not yet.
  void remove(int vehicle) { boxes_[vehicle].is_there = false; }
  /// Measures every pair that is there, once per tick. Of pairs whose enclosing spheres are farther
  /// apart than the pair has come before, only the spheres are looked at. No heap.
  void update(Time now);

  /// Of the nearest other one; distance +infinity where there never was one.
  const Least& least(int vehicle) const { return least_[vehicle]; }
  /// Of two vehicles, in any order; `other` is the second. @pre a != b
  Least least(int a, int b) const;

 private:
  struct Box {
    bool is_there = false;
    Pose X_WC;
    Eigen::Vector3d half_m = Eigen::Vector3d::Zero();
    double radius_m = 0.0;
  };
  int pair(int a, int b) const { return a * vehicles() + b; }

  std::vector<Box> boxes_;
  std::vector<Least> least_;  ///< by vehicle
  std::vector<Least> pairs_;  ///< by pair, both ways
};

}  // namespace vinerow
