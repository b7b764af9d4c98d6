#pragma once
/// Cuts polygons of mesh files into triangles.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vinerow::io {

/// Appends count - 2 triangles that cover the polygon and keep its sense of turning. Convex ones
/// become a fan, others lose ear after ear (G. H. Meisters, "Polygons have ears", 1975), seen along
/// their mean normal. Where no ear is left (a polygon that crosses itself) the rest becomes a fan.
/// Cost: n for convex polygons, n^3 at worst. @pre at least 3 corners
void triangulate_polygon(const std::vector<Eigen::Vector3f>& vertices,
                         std::span<const std::uint32_t> polygon,
                         std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace vinerow::io
