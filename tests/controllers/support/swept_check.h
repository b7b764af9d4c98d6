#pragma once
/// Judges a plan without the planner's own means: polygons against the grid's squares.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "controllers/parts/paths/pose2.h"
#include "engine/api/forward.h"

namespace vinerow::test {

/// Least distance from a convex polygon at a pose to any taken square, m; 0 where they overlap or
/// where the polygon leaves the grid. Exact, by edges and corners. @param reach_m  how far is
/// looked
double distance_to_cells(const std::vector<Eigen::Vector2d>& outline_B,
                         const controllers::Pose2& pose, const OccupancyGrid& grid,
                         double reach_m = 0.5);

struct SweptVerdict {
  double min_m = 1e9;  ///< distance to anything taken, over the whole plan
  double sharpest_per_m = 0.0;
  double length_m = 0.0;  ///< of the arcs between the points
  std::string fault;      ///< the first point where the plan is not one smooth curve
};

/// Follows the arcs between a plan's points at steps of `step_m`.
SweptVerdict check_swept(const PlannedPath& path, const std::vector<Eigen::Vector2d>& outline_B,
                         const OccupancyGrid& grid, double step_m = 0.05);

}  // namespace vinerow::test
