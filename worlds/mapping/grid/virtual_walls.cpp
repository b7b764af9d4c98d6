#include "worlds/mapping/grid/virtual_walls.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "engine/api/map.h"
#include "engine/math/planar.h"
#include "engine/math/polygon.h"

namespace vinerow::mapping {

using Eigen::Vector2d;

std::optional<Vector2d> nearest_forward_hit(const Vector2d& from_W, const Vector2d& direction,
                                            const std::vector<Vector2d>& polygon_W) {
  constexpr double kForward_m = 1e-9;   // nearer hits are the start itself
  constexpr double kEdgeShare = 1e-12;  // a ray through a vertex must not slip between two edges
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < polygon_W.size(); ++k) {
    const Vector2d& a = polygon_W[k];
    const Vector2d edge = polygon_W[(k + 1) % polygon_W.size()] - a;
    // from + t direction = a + u edge; edges along the ray are met at their ends by the next ones.
    const double across = cross(direction, edge);
    if (std::abs(across) < 1e-12 * edge.norm()) continue;
    const double t_m = cross(a - from_W, edge) / across;
    const double u = cross(a - from_W, direction) / across;
    if (t_m > kForward_m && u >= -kEdgeShare && u <= 1.0 + kEdgeShare && t_m < nearest_m) {
      nearest_m = t_m;
    }
  }
  if (!std::isfinite(nearest_m)) return std::nullopt;
  return from_W + nearest_m * direction;
}

RowEnd first_wall_of(const RowMap& map) {
  const bool alley_before_row_0 = map.alleys.size() > map.rows.size();
  return alley_before_row_0 ? RowEnd::kFirst : RowEnd::kLast;
}

std::vector<VirtualWall> make_virtual_walls(const RowMap& map, RowEnd first_wall,
                                            std::vector<std::string>& notes) {
  std::vector<VirtualWall> walls;
  for (std::size_t k = 0; k < map.rows.size(); ++k) {
    const auto& line = map.rows[k].line_W;
    VirtualWall wall;
    wall.row = static_cast<int>(k);
    wall.end = k % 2 == 0 ? first_wall : other_end(first_wall);
    const bool last = wall.end == RowEnd::kLast;
    wall.from_W = (last ? line.back() : line.front()).head<2>();
    const Vector2d before_W = (last ? line[line.size() - 2] : line[1]).head<2>();
    const Vector2d outward = (wall.from_W - before_W).normalized();
    const auto hit = contains(map.boundary_W, wall.from_W)
                         ? nearest_forward_hit(wall.from_W, outward, map.boundary_W)
                         : std::nullopt;
    if (!hit) {
      notes.push_back(fmt::format(
          "row {} has no virtual wall: its {} point ({:.2f}, {:.2f}) m is not inside the parcel's "
          "boundary",
          k, last ? "last" : "first", wall.from_W.x(), wall.from_W.y()));
      continue;
    }
    wall.to_W = *hit;
    walls.push_back(wall);
  }
  return walls;
}

}  // namespace vinerow::mapping
