#pragma once
/// The convex polygon of few corners and least area around points: what a cross-section of the
/// canopy becomes in a low-complexity map.
///
/// Source: Comba et al., "Semantic interpretation and complexity reduction of 3D point clouds of
/// vineyards", Biosystems Engineering 197 (2020), the "minimum area c-gon containing a point set"
/// of paper A's section 3 (Mammarella et al., Biosystems Engineering 223, 2022). How it is solved
/// is ours, on the flush lemma of Aggarwal, Chang and Yap, "Minimum area circumscribing polygons",
/// The Visual Computer 1 (1985): some c-gon of least area has all sides but one along sides of the
/// convex hull, and the remaining one, if it is not, touches a hull corner with its middle.
///
/// In any plane, in m. All points are inside to 1e-12 of their extent, or to the
/// rounding of their coordinates where that is more. Points whose hull has at most `corners`
/// corners get the hull, all others a polygon of exactly `corners`.
///
/// @param points   in any order, repeated or not
/// @param corners  most that the polygon may have, >= 3
/// @returns corners counter-clockwise; or why there is none: fewer than three corners asked for, no
/// points, a coordinate that is not finite or beyond 1e9, points on one line (hull area <= 1e-9 of
/// the square of their extent)

#include "engine/core/result.h"
#include "engine/math/polygon.h"

namespace vinerow::mapping {

/// The least area there is. Cost: n points sorted; of h hull corners at most O(h^3 corners), of
/// which what cannot beat a greedy choice of sides is left out: 0.03 ms for 20 hull corners and 8,
/// 0.3 ms for 60, 2 ms for 120.
Result<Polygon> smallest_enclosing_polygon(const Polygon& points, int corners);

}  // namespace vinerow::mapping
