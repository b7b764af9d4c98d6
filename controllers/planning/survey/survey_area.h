#pragma once
/// The polygon to be surveyed, in the plane of W.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/geo_origin.h"

namespace vinerow::controllers {

using Polygon2 = std::vector<Eigen::Vector2d>;

/// Without repeated points and without a last point that repeats the first.
Polygon2 clean_polygon(const Polygon2& polygon);

/// What keeps a cleaned polygon from being surveyed: fewer than 3 points, no area, edges that cross
/// or touch. @returns "its edge from point 1 (0.0, 0.0) to point 2 ... crosses ..."
std::optional<std::string> find_polygon_fault(const Polygon2& polygon);

/// Positive where the points run counter-clockwise, m2.
double polygon_area_m2(const Polygon2& polygon);
bool is_inside_polygon(const Eigen::Vector2d& p, const Polygon2& polygon);

/// Every edge moved outwards by `margin_m` (inwards where negative); sharp corners are cut off at
/// twice the margin. Empty where an edge vanishes; may give a polygon that crosses itself.
Polygon2 widen_polygon(const Polygon2& polygon, double margin_m);

/// The only polygon of a GeoJSON file (its outer ring), or lines "x,y" in metres of W of a CSV
/// file. @throws ConfigError naming the file: none or several polygons, lines that are no numbers
Polygon2 read_survey_area(const std::string& file, const GeoOrigin& origin);

}  // namespace vinerow::controllers
