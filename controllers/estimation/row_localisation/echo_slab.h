#pragma once
/// Slab of possible vehicle positions for an echo from a facet of the map.
///
/// The echo ends on the facet's plane N.x = D, up to bounded errors. So the position is between two
/// planes:
///
///     N'p = D - N'(R l + d u),   |error| <= |N'u| e_s + e_m + e_psi |N'(z x v)| + e_psi^2/2
///     |N_h'v|
///
/// with d the reading, l the sensor in B, u its direction in W, v = R l + d u, z up, N_h the
/// horizontal part of N, and bounds e_s of the reading, e_m of the map along N, e_psi of the
/// heading. This replaces paper C's eq. 10-12, which hold only for sensors that look across the
/// vehicle and lose the side of the wall (arctan); docs/papers/localisation.md.

#include "controllers/estimation/row_localisation/range_prediction.h"

namespace vinerow::controllers {

/// Bounds of the errors, each >= 0.
struct EchoBounds {
  double reading_m = 0.003;  ///< e_s
  double map_m = 0.09;       ///< e_m, along the facet's normal
  double yaw_rad = 0.0;      ///< e_psi
};

/// lower_m <= N.p <= upper_m for the origin p of B in W.
struct EchoSlab {
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitX();  ///< N, unit
  double lower_m = 0.0, upper_m = 0.0;

  double half_width_m() const { return 0.5 * (upper_m - lower_m); }
};

/// @param facet  the facet that returned the echo, seen from p_WB; its origin, direction and plane
/// are used
/// @param range_m  d
EchoSlab echo_slab(const RangePrediction& facet, const Eigen::Vector3d& p_WB, double range_m,
                   const EchoBounds& bounds);

/// Slab in the horizontal plane: lower_m <= a.p <= upper_m with a = N_xy.
struct EchoSlab2 {
  Eigen::Vector2d a = Eigen::Vector2d::UnitX();
  double lower_m = 0.0, upper_m = 0.0;
};

/// @param height_m  of the origin of B in W  @param height_bound_m  bound of its error, >= 0
EchoSlab2 horizontal_slab(const EchoSlab& slab, double height_m, double height_bound_m);

}  // namespace vinerow::controllers
