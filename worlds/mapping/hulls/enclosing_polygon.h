#pragma once
/// Smallest convex polygon with few corners around points, for cross-sections of the canopy in a
/// low-complexity map.
///
/// Source: Comba et al., "Semantic interpretation and complexity reduction of 3D point clouds of
/// vineyards", Biosystems Engineering 197 (2020), the "minimum area c-gon containing a point set"
/// of paper A's section 3 (Mammarella et al., Biosystems Engineering 223, 2022). The solver is our
/// own and uses the flush lemma of Aggarwal, Chang and Yap, "Minimum area circumscribing polygons",
/// The Visual Computer 1 (1985): some c-gon of least area has all sides but one along sides of the
/// convex hull, and the remaining one, if it is not, touches a hull corner with its middle.
///
/// In any plane, in m. All points are inside to 1e-12 of their extent, or to the rounding of their
/// coordinates if that is larger. The result is the convex hull if it has at most `corners`
/// corners, else a polygon with exactly `corners`.
///
/// @param points   in any order, repeated or not
/// @param corners  upper limit, >= 3
/// @returns corners counter-clockwise, or the reason for failure: a limit below three corners, no
/// points, a coordinate that is not finite or beyond 1e9, points on one line (hull area <= 1e-9 of
/// the square of their extent)

#include "engine/core/result.h"
#include "engine/math/polygon.h"

namespace vinerow::mapping {

/// The area is the global minimum. Cost: sorting of n points; for h hull corners at most
/// O(h^3 corners), with candidates pruned that cannot beat a greedy choice of sides: 0.03 ms for 20
/// hull corners and 8, 0.3 ms for 60, 2 ms for 120.
Result<Polygon> smallest_enclosing_polygon(const Polygon& points, int corners);

}  // namespace vinerow::mapping
