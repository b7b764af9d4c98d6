/// make_turning_areas() of virtual_walls.h.

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/map.h"
#include "engine/math/polygon.h"
#include "engine/math/polyline.h"
#include "worlds/mapping/grid/virtual_walls.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;

double from_segment_m(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  return (nearest_on_segment<2>(p, a, b) - p).norm();
}

/// Of two segments that do not cross.
double between_walls_m(const VirtualWall& a, const VirtualWall& b) {
  return std::min(
      {from_segment_m(a.from_W, b.from_W, b.to_W), from_segment_m(a.to_W, b.from_W, b.to_W),
       from_segment_m(b.from_W, a.from_W, a.to_W), from_segment_m(b.to_W, a.from_W, a.to_W)});
}

Vector2d end_point(const PlantRow& row, RowEnd end) {
  return (end == RowEnd::kLast ? row.line_W.back() : row.line_W.front()).head<2>();
}

Vector2d outward_at(const PlantRow& row, RowEnd end) {
  const auto& line = row.line_W;
  const Vector2d before = (end == RowEnd::kLast ? line[line.size() - 2] : line[1]).head<2>();
  return (end_point(row, end) - before).normalized();
}

/// Where on the polygon a point of its edge lies: edge number + share.
double station_of(const Vector2d& p, const std::vector<Vector2d>& polygon) {
  double best_m = std::numeric_limits<double>::infinity(), station = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    if ((b - a).squaredNorm() == 0.0) continue;  // a corner given twice
    const double apart_m = from_segment_m(p, a, b);
    if (apart_m < best_m) {
      best_m = apart_m;
      station = static_cast<double>(k) + segment_share<2>(p, a, b);
    }
  }
  return station;
}

/// The polygon's vertices passed on the way from one station up to the other, around if need be.
std::vector<Vector2d> vertices_between(double from, double to,
                                       const std::vector<Vector2d>& polygon) {
  const auto count = static_cast<double>(polygon.size());
  if (to < from) to += count;
  std::vector<Vector2d> passed;
  for (double k = std::floor(from) + 1.0; k <= to; k += 1.0) {
    passed.push_back(polygon[static_cast<std::size_t>(std::fmod(k, count))]);
  }
  return passed;
}

/// The ground between two walls, beyond the open row end. Of the two ways around the parcel the one
/// that leaves the open row outside.
std::vector<Vector2d> area_between(const VirtualWall& a, const VirtualWall& b,
                                   const Vector2d& open_W, const Vector2d& row_middle_W,
                                   const std::vector<Vector2d>& boundary) {
  const double from = station_of(a.to_W, boundary), to = station_of(b.to_W, boundary);
  const auto close = [&](const std::vector<Vector2d>& chain) {
    std::vector<Vector2d> polygon = {open_W, a.from_W, a.to_W};
    polygon.insert(polygon.end(), chain.begin(), chain.end());
    polygon.push_back(b.to_W);
    polygon.push_back(b.from_W);
    return polygon;
  };
  std::vector<Vector2d> ahead = close(vertices_between(from, to, boundary));
  std::vector<Vector2d> back = vertices_between(to, from, boundary);
  std::reverse(back.begin(), back.end());
  return contains(ahead, row_middle_W) ? close(back) : ahead;
}

/// Beside an outer row: the boundary abreast of its open end, from there to where it ends the area.
std::optional<VirtualWall> side_wall(const PlantRow& row, RowEnd end, const Vector2d& away_W,
                                     const std::vector<Vector2d>& boundary) {
  constexpr double kInside_m = 1e-6;
  const auto side = nearest_forward_hit(end_point(row, end), away_W, boundary);
  if (!side) return std::nullopt;
  const auto corner =
      nearest_forward_hit(*side - kInside_m * away_W, outward_at(row, end), boundary);
  if (!corner) return std::nullopt;
  VirtualWall wall;
  wall.from_W = *side;
  wall.to_W = *corner;
  return wall;
}

}  // namespace

std::vector<TurningArea> make_turning_areas(const RowMap& map,
                                            const std::vector<VirtualWall>& walls) {
  std::vector<TurningArea> areas;
  const int count = static_cast<int>(map.rows.size());
  const bool outer_alleys = map.alleys.size() > map.rows.size();
  const auto wall_of = [&](int row) -> std::optional<VirtualWall> {
    for (const VirtualWall& wall : walls) {
      if (wall.row == row) return wall;
    }
    return std::nullopt;
  };
  for (int k = 0; k < count; ++k) {
    const bool outer = k == 0 || k + 1 == count;
    const auto own = wall_of(k);
    if (!own || (outer && !outer_alleys)) continue;
    const PlantRow& row = map.rows[static_cast<std::size_t>(k)];
    const RowEnd open = other_end(own->end);
    const Vector2d open_W = end_point(row, open), outward = outward_at(row, open);
    // Towards row k + 1: to the left or right of the outward direction.
    Vector2d towards_next(-outward.y(), outward.x());
    if (count > 1) {
      const int neighbour = k + 1 < count ? k + 1 : k - 1;
      const Vector2d there = end_point(map.rows[static_cast<std::size_t>(neighbour)], open);
      const double sign = k + 1 < count ? 1.0 : -1.0;
      if (sign * towards_next.dot(there - open_W) < 0.0) towards_next = -towards_next;
    }
    const auto before =
        k > 0 ? wall_of(k - 1) : side_wall(row, open, -towards_next, map.boundary_W);
    const auto after =
        k + 1 < count ? wall_of(k + 1) : side_wall(row, open, towards_next, map.boundary_W);
    if (!before || !after) continue;
    TurningArea area;
    area.row = k;
    area.end = open;
    area.width_m = between_walls_m(*before, *after);
    area.polygon_W = area_between(*before, *after, open_W,
                                  row.line_W[row.line_W.size() / 2].head<2>() * 0.5 +
                                      row.line_W[row.line_W.size() / 2 - 1].head<2>() * 0.5,
                                  map.boundary_W);
    areas.push_back(std::move(area));
  }
  return areas;
}

}  // namespace vinerow::mapping
