#pragma once
/// What a way costs: its length, more where it runs close to something, and something for every
/// change of curvature, during which the wheels have to be turned.

#include <vector>

#include "controllers/parts/paths/footprint.h"
#include "controllers/parts/paths/path_pieces.h"

namespace vinerow::controllers {

struct WayCostParams {
  double clearance_weight = 0.5;    ///< a metre driven at no clearance costs 1 + this
  double wanted_clearance_m = 0.3;  ///< from here on a metre costs one
  double bend_m = 0.2;              ///< every change of curvature costs as much as this length
  double step_m = 0.25;             ///< between poses looked at
};

/// Integral of 1 + weight * max(0, 1 - clearance / wanted) along the way, and the bends. Never less
/// than the length, so that a Dubins length bounds it from below.
class WayCost {
 public:
  WayCost(const WayCostParams& params, const Footprint& footprint);

  double of(const PathPiece& piece) const;
  double of(const std::vector<PathPiece>& pieces) const;
  double of(const Pose2& start, const DubinsPath& path) const;
  /// Of a Dubins path of this length with no clearance anywhere.
  double most_of(double length_m) const {
    return length_m * (1.0 + params_.clearance_weight) + 2.0 * params_.bend_m;
  }

 private:
  double of_arc(const Pose2& start, double length_m, double curvature_per_m) const;
  double rough_clearance_m(const Pose2& pose) const;

  WayCostParams params_;
  const DistanceField& field_;
  std::vector<Eigen::Vector2d> looked_at_B_;  // corners and edge middles of the outline
};

}  // namespace vinerow::controllers
