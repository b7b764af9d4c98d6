#pragma once
/// How far a point is from the goal: straight (paper A, eq. 22), or along the free ground.
///
/// The straight distance points into the next row when the goal is in the next alley; the distance
/// along the ground leads around the row's end. It is a shortest way over a grid of 0.2 m cells,
/// to all eight neighbours, grown from the goal (Dijkstra 1959, with Dial's buckets). Cells where
/// not even the circle inside the vehicle's outline fits, taken one cell diagonal smaller for the
/// grid's coarseness, are no ground: what it does not reach, no vehicle reaches.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/paths/footprint.h"

namespace vinerow::controllers {

enum class DistanceKind { kEuclid, kGeodesic };

class GoalDistance {
 public:
  /// @param from  the search's start: the ground is measured until well beyond it
  GoalDistance(DistanceKind kind, const Footprint& footprint, const Eigen::Vector2d& from,
               const Eigen::Vector2d& goal);

  /// m, >= 0; infinity for what the ground does not reach or was not measured any more.
  double at(const Eigen::Vector2d& p_W) const;

 private:
  void measure(const Footprint& footprint, const Eigen::Vector2d& from);

  Eigen::Vector2d goal_;
  int columns_ = 0;  // 0: straight distance
  int rows_ = 0;
  Eigen::Vector2d corner_W_ = {0, 0};
  std::vector<int> steps_;  // fifths of a cell from the goal's cell; x fastest
};

}  // namespace vinerow::controllers
