#pragma once
/// Smallest true distance between the boxes of vehicles over a run.

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "engine/api/result_spec.h"
#include "engine/core/time.h"
#include "engine/math/pose.h"

namespace vinerow {

class Separation {
 public:
  /// Closest approach of a vehicle to another one.
  struct MinDistance {
    double distance_m = std::numeric_limits<double>::infinity();  ///< 0: touched or overlapped
    int other = -1;  ///< the other vehicle, -1 if there was never one
    Time time;       ///< of the first moment at this distance
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< centre of this vehicle's box then
  };

  /// @param vehicles  number of vehicles, at least 1
  explicit Separation(int vehicles);

  int vehicles() const { return static_cast<int>(boxes_.size()); }
  /// Sets the present place of a vehicle's box. @param X_WB  pose of the vehicle
  /// @param centre_B  of the box  @param half_extents_m  along the axes of B
  void place(int vehicle, const Pose& X_WB, const Eigen::Vector3d& centre_B,
             const Eigen::Vector3d& half_extents_m);
  /// Excludes a vehicle until its next place().
  void remove(int vehicle) { boxes_[vehicle].is_there = false; }
  /// Measures every pair of placed vehicles; once per tick. Computes the distance of the boxes only
  /// if the enclosing spheres are nearer than the pair's minimum so far. Does not allocate.
  void update(Time now);

  /// Closest approach to any other vehicle; distance +infinity if there never was one.
  const MinDistance& closest(int vehicle) const { return closest_[vehicle]; }
  /// Closest approach of two vehicles, in any order; `other` is the second. @pre a != b
  MinDistance closest(int a, int b) const;

 private:
  struct Box {
    bool is_there = false;
    Pose X_WC;
    Eigen::Vector3d half_m = Eigen::Vector3d::Zero();
    double radius_m = 0.0;
  };
  int pair(int a, int b) const { return a * vehicles() + b; }

  std::vector<Box> boxes_;
  std::vector<MinDistance> closest_;  ///< by vehicle
  std::vector<MinDistance> pairs_;    ///< by pair, both ways
};

/// Declaration of the result `min_vehicle_distance_m` of every vehicle in runs with several ones.
const std::vector<ResultSpec>& separation_results();

}  // namespace vinerow
