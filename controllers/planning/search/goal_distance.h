#pragma once
/// Distance of a point from the goal: straight (paper A, eq. 22), or along the free ground.
///
/// If the goal is in the next alley, the straight distance leads into the row between; the distance
/// along the ground leads around the row's end. It is the shortest path over a grid of 0.2 m cells
/// with eight neighbours, grown from the goal (Dijkstra 1959, with Dial's buckets). A cell is
/// blocked if it has no space for the inscribed circle of the vehicle's outline, reduced by one
/// cell diagonal because of the grid's resolution. Cells that this search does not reach, no
/// vehicle reaches.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/paths/footprint.h"

namespace vinerow::controllers {

enum class DistanceKind { kEuclid, kGeodesic };

class GoalDistance {
 public:
  /// @param from  start of the search; the ground is measured until well beyond it
  GoalDistance(DistanceKind kind, const Footprint& footprint, const Eigen::Vector2d& from,
               const Eigen::Vector2d& goal);

  /// Distance, m, >= 0; infinity for points that are not reachable or beyond the measured ground.
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
