#pragma once
/// Shape of a vine row's canopy: cross-sections that vary from vine to vine.
///
/// A stretch of some vines has its own shape (CanopyShape). Both the closed hull for physics, rays
/// and distances and the leaves for display are made from it, so that they agree.
/// Local frame of a stretch: u along the row from its start, lateral to the left, height above
/// ground; m.

#include <Eigen/Core>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/core/random.h"
#include "worlds/mapping/model/row_curve.h"
#include "worlds/mapping/model/row_map.h"

namespace vinerow::worlds {

/// Mean cross-section and its variation.
struct CanopyParams {
  double width_m = 0.55;
  double base_m = 0.55;  ///< lowest leaves above ground
  double top_m = 2.0;
  double variation =
      0.12;  ///< standard deviation of width and height from vine to vine, share; cut at 2 sigma
  double step_m = 0.15;  ///< between the hull's sections
  int ring_points = 12;  ///< of a hull section, even, >= 6
};

/// `canopy_base_m`, `canopy_top_m`, `canopy_variation`, `canopy_step_m`; the width is
/// VinePlanting's. The base must be below the top.
const ParameterTable<CanopyParams>& canopy_table();

/// Canopy figures for the row map.
mapping::CanopySize canopy_size(const CanopyParams& params);

/// Cross-section: a super-ellipse, |2y/w|^3 + |2(z-m)/h|^3 = 1.
struct CanopySection {
  double width_m;
  double base_m;
  double top_m;
  double shift_m;  ///< of the middle to the left
};

class CanopyShape {
 public:
  /// @param vine_count  vines spread evenly over the length
  CanopyShape(const CanopyParams& params, double length_m, int vine_count, RandomStream random);

  double length_m() const { return length_m_; }
  /// Section at u in [0, length], blended between vines. Never wider than 1.35 times nor higher
  /// than 1.15 times the mean, never lower than 0.85 of the mean base.
  CanopySection section(double u_m) const;
  /// Point on the surface. @param angle_rad  0 = left, pi/2 = top @returns (lateral, height), m
  Eigen::Vector2d surface_point(double u_m, double angle_rad) const;
  /// Outward normal of the smooth section in the (lateral, height) plane, unit.
  Eigen::Vector2d surface_normal(double u_m, double angle_rad) const;

 private:
  double length_m_;
  std::vector<CanopySection> vines_;
  double lump_m_;
  double phases_[4];
};

/// Stretch of a row with its shape.
struct CanopyStretch {
  double start_m;  ///< arc length
  double end_m;
  const CanopyShape* shape;
};

/// Closed hull in W of neighbouring stretches (end of one = start of the next), rounded at both
/// ends.
TriangleMesh make_canopy_hull(const mapping::RowCurve& row, const mapping::GroundHeight& ground,
                              const std::vector<CanopyStretch>& stretches,
                              const CanopyParams& params);

}  // namespace vinerow::worlds
