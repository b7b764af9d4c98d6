#pragma once
/// Plan with heights as an exact curve in space: arcs by curvature in plan view, linear in height
/// between two points, straight up and down. It is divided into runs that a vehicle can fly without
/// a stop.

#include <Eigen/Core>
#include <vector>

#include "controllers/parts/paths/pose2.h"
#include "engine/api/forward.h"
#include "engine/api/messages/path.h"

namespace vinerow::controllers {

/// Segment between two points of a plan.
struct CurveSegment {
  Pose2 start;
  double start_height_m = 0.0;
  double plan_length_m = 0.0;  ///< in plan view; 0: straight up or down
  double rise_m = 0.0;
  double curvature_per_m = 0.0;
  double length_m = 0.0;   ///< in space
  double speed_mps = 0.0;  ///< 0: no wanted speed
  PathKind kind = PathKind::kTransit;

  bool is_vertical() const;
  /// @param at_m  distance in space from the segment's start
  Eigen::Vector3d at(double at_m) const;
  double end_yaw_rad() const { return start.yaw_rad + plan_length_m * curvature_per_m; }
};

/// Segments that join smoothly: either all of them straight up or all straight down, or none of
/// them vertical and no bend between two of them sharper than `sharp_rad`.
struct CurveRun {
  std::vector<CurveSegment> pieces;
  bool is_vertical = false;
  double length_m = 0.0;
};

/// @returns empty if the plan has no length
std::vector<CurveRun> make_curve_runs(const PlannedPath& plan, double sharp_rad);

}  // namespace vinerow::controllers
