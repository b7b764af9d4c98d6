#pragma once
/// Polygons in the plane: area, containment, distance, clipping. Corners are in order; the last
/// joins the first.

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

namespace vinerow {

using Polygon = std::vector<Eigen::Vector2d>;

/// Positive if the corners run counter-clockwise; 0 for fewer than three. Shoelace formula.
double signed_area_m2(const Polygon& polygon);

/// Point in polygon by the even-odd rule; points on an edge may count as inside or outside.
bool contains(const Polygon& polygon, const Eigen::Vector2d& p);

/// Distance from p to the nearest point of the polygon; 0 inside. @pre two corners or more
double distance_m(const Polygon& polygon, const Eigen::Vector2d& p);

/// Smallest convex polygon around the points, counter-clockwise, without corners on its edges.
/// Source: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.
Polygon convex_hull(Polygon points);

/// Part of `subject` inside `convex`. If a non-convex subject splits, its parts stay connected by
/// edges of zero width, which have no area. Source: Sutherland, Hodgman, "Reentrant polygon
/// clipping", 1974.
/// @param convex  counter-clockwise
Polygon clip(const Polygon& subject, const Polygon& convex);

/// Part of a convex polygon to the left of the line through p along d; empty if it has no area.
Polygon cut(const Polygon& convex, const Eigen::Vector2d& p, const Eigen::Vector2d& d);

/// Section of the straight line p + t d inside a convex polygon.
/// @param convex  counter-clockwise
/// @returns {from, to} in units of t; from >= to if the line misses the polygon
Eigen::Vector2d clip_line(const Polygon& convex, const Eigen::Vector2d& p,
                          const Eigen::Vector2d& d);

/// First two edges, by the index of their first corner, that cross or touch anywhere but at a
/// shared corner. nullopt if the polygon is simple.
std::optional<std::pair<int, int>> find_crossing(const Polygon& polygon);

/// Polygon without repeated corners, and without a last corner that repeats the first, to a
/// micrometre.
Polygon without_repeats(const Polygon& polygon);

/// Polygon with every edge moved outwards by `margin_m`, inwards if negative; sharp corners are cut
/// off at twice the margin. Empty if an edge vanishes; the result may cross itself.
Polygon widen(const Polygon& polygon, double margin_m);

/// Convex polygon with every edge moved inwards. @param convex  counter-clockwise
/// @returns empty if nothing is left
Polygon inset(const Polygon& convex, double inset_m);

}  // namespace vinerow
