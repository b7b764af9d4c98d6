#pragma once
/// A plan with heights as an exact curve in space: arcs by curvature seen from above, straight in
/// height between two points, straight up and down; parted into runs that a vehicle can fly without
/// stopping.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/paths/pose2.h"
#include "engine/api/forward.h"
#include "engine/api/messages/path.h"

namespace vinerow::controllers {

/// Between two points of a plan.
struct CurvePiece {
  Pose2 start;
  double start_height_m = 0.0;
  double plan_length_m = 0.0;  ///< seen from above; 0: straight up or down
  double rise_m = 0.0;
  double curvature_per_m = 0.0;
  double length_m = 0.0;   ///< in space
  double speed_mps = 0.0;  ///< 0: none wanted
  PathKind kind = PathKind::kTransit;

  bool is_vertical() const;
  /// @param at_m  distance in space from the piece's start
  Eigen::Vector3d at(double at_m) const;
  double end_yaw_rad() const { return start.yaw_rad + plan_length_m * curvature_per_m; }
};

/// Pieces that join smoothly: all of them straight up or down the same way, or none of them and no
/// bend between two sharper than `sharp_rad`.
struct CurveRun {
  std::vector<CurvePiece> pieces;
  bool is_vertical = false;
  double length_m = 0.0;
};

/// @returns empty where the plan has no length
std::vector<CurveRun> make_curve_runs(const PlannedPath& plan, double sharp_rad);

}  // namespace vinerow::controllers
