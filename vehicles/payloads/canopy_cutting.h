#pragma once
/// Cutting of canopy triangles along the borders of patches, so that areas are exact.

#include <Eigen/Core>
#include <functional>

#include "vehicles/payloads/worked_rows.h"

namespace vinerow::vehicles {

/// Point of the canopy with its position on its row.
struct CanopyPoint {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  int row = 0;
  double along_m = 0.0;
  double lateral_m = 0.0;
  double height_m = 0.0;  ///< above the ground at the row's line
};

CanopyPoint canopy_point(const RowLines& rows, const Eigen::Vector3d& p_W);

/// Piece of a triangle in one patch. Indices may be beyond the row's ends and below the ground.
struct CanopyPiece {
  int row = 0;
  int side = 1;
  int along = 0;
  int band = 0;
  double area_m2 = 0.0;
  Eigen::Vector3d middle_W = Eigen::Vector3d::Zero();
};

/// Cuts one triangle. The areas of the pieces sum up to its area. A triangle over which the
/// position on the row is not linear (a bend, the border of two rows) is quartered until it is, or
/// until it is smaller than a hundredth of a patch.
void cut_canopy_triangle(const RowLines& rows, const CanopyPoint& a, const CanopyPoint& b,
                         const CanopyPoint& c, double step_m, double band_m,
                         const std::function<void(const CanopyPiece&)>& take);

}  // namespace vinerow::vehicles
