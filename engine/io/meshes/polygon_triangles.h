#pragma once
/// Triangulation of polygons in mesh files.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vinerow::io {

/// Appends count - 2 triangles that cover the polygon and keep its orientation. Convex polygons
/// become a fan. Others are cut by ear clipping (G. H. Meisters, "Polygons have ears", 1975) in the
/// plane normal to their mean normal. If no ear is left (a self-intersecting polygon), the rest
/// becomes a fan. Cost: O(n) for convex polygons, O(n^3) at worst. @pre at least 3 corners
void triangulate_polygon(const std::vector<Eigen::Vector3f>& vertices,
                         std::span<const std::uint32_t> polygon,
                         std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace vinerow::io
