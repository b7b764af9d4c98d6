#pragma once
/// Cost of a path: its length, more near obstacles, and an amount for every change of curvature,
/// which takes time to steer.

#include <vector>

#include "controllers/parts/paths/footprint.h"
#include "controllers/parts/paths/path_pieces.h"

namespace vinerow::controllers {

struct PathCostParams {
  double clearance_weight = 0.5;    ///< a metre at zero clearance costs 1 + this
  double wanted_clearance_m = 0.3;  ///< at this clearance and more a metre costs 1
  double bend_m = 0.2;              ///< every change of curvature costs as much as this length
  double step_m = 0.25;             ///< between poses that are evaluated
};

/// Integral of 1 + weight * max(0, 1 - clearance / wanted) along the path, plus the bends. Never
/// less than the length, so that a Dubins length is a lower bound.
class PathCost {
 public:
  PathCost(const PathCostParams& params, const Footprint& footprint);

  double of(const PathSegment& piece) const;
  double of(const std::vector<PathSegment>& pieces) const;
  double of(const Pose2& start, const DubinsPath& path) const;
  /// Upper bound: cost of a Dubins path of this length with zero clearance everywhere.
  double max_of(double length_m) const {
    return length_m * (1.0 + params_.clearance_weight) + 2.0 * params_.bend_m;
  }

 private:
  double of_arc(const Pose2& start, double length_m, double curvature_per_m) const;
  double rough_clearance_m(const Pose2& pose) const;

  PathCostParams params_;
  const DistanceField& field_;
  std::vector<Eigen::Vector2d> looked_at_B_;  // corners and edge midpoints of the outline
};

}  // namespace vinerow::controllers
