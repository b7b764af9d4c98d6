#pragma once
/// Areas from files, as polygons in the horizontal plane of W.

#include <optional>
#include <string>

#include "engine/math/geo_origin.h"
#include "engine/math/polygon.h"

namespace vinerow::io {

/// The only polygon of a file with geographic features (its outer ring), or lines "x,y" in metres
/// of W of a CSV file, without repeated corners. @throws ConfigError with the file's name if it has
/// no or several polygons, or lines that are not numbers
Polygon read_area(const std::string& file, const GeoOrigin& origin);

/// Fault of an area without repeated corners: fewer than 3 points, no area, edges that
/// cross or touch. @returns "its edge from point 1 (0.0, 0.0) to point 2 ... crosses ..."
std::optional<std::string> find_area_fault(const Polygon& polygon);

}  // namespace vinerow::io
