#pragma once
/// Polygons in the plane: area, what is inside, how far it is, what two have in common. Corners in
/// order, the last joins the first.

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

namespace vinerow {

using Polygon = std::vector<Eigen::Vector2d>;

/// Positive where the corners run counter-clockwise; 0 for fewer than three. Shoelace formula.
double signed_area_m2(const Polygon& polygon);

/// By the even-odd rule; points on an edge may fall to either side.
bool contains(const Polygon& polygon, const Eigen::Vector2d& p);

/// From p to the nearest point of the polygon; 0 inside. @pre two corners or more
double distance_m(const Polygon& polygon, const Eigen::Vector2d& p);

/// Smallest convex polygon around the points, counter-clockwise, without corners on its edges.
/// Source: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.
Polygon convex_hull(Polygon points);

/// The part of `subject` inside `convex`. Where a subject that is not convex falls apart, its
/// pieces hang together by edges of no width, which have no area. Source: Sutherland, Hodgman,
/// "Reentrant polygon clipping", 1974.
/// @param convex  counter-clockwise
Polygon clip(const Polygon& subject, const Polygon& convex);

/// The part of a convex polygon to the left of the line through p along d; empty if it has no area.
Polygon cut(const Polygon& convex, const Eigen::Vector2d& p, const Eigen::Vector2d& d);

/// Where the straight line p + t d runs inside a convex polygon.
/// @param convex  counter-clockwise
/// @returns {from, to} in units of t; from >= to where it does not
Eigen::Vector2d clip_line(const Polygon& convex, const Eigen::Vector2d& p,
                          const Eigen::Vector2d& d);

/// The first two edges, by the index of their first corner, that cross or touch elsewhere than at a
/// corner that they share. Nothing: the polygon is simple.
std::optional<std::pair<int, int>> find_crossing(const Polygon& polygon);

}  // namespace vinerow
