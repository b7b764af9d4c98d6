#pragma once
/// Ways over an occupancy grid, for tests: plain searches that share no code with the product.

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "engine/api/map.h"

namespace vinerow::test {

inline Eigen::Vector2i cell_of(const OccupancyGrid& grid, const Eigen::Vector2d& p_W) {
  const Eigen::Vector2d q = (p_W - grid.corner_W) / grid.cell_m;
  return {static_cast<int>(std::floor(q.x())), static_cast<int>(std::floor(q.y()))};
}

inline bool occupied_at(const OccupancyGrid& grid, const Eigen::Vector2d& p_W) {
  const Eigen::Vector2i c = cell_of(grid, p_W);
  if (c.x() < 0 || c.y() < 0 || c.x() >= grid.columns || c.y() >= grid.rows) return true;
  return grid.occupied(c.x(), c.y());
}

/// Length of the shortest path over free cells from one point to another, steps to all eight
/// neighbours, m; infinite where there is none.
inline double path_length_m(const OccupancyGrid& grid, const Eigen::Vector2d& from_W,
                            const Eigen::Vector2d& to_W) {
  const Eigen::Vector2i from = cell_of(grid, from_W), to = cell_of(grid, to_W);
  const double infinite = std::numeric_limits<double>::infinity();
  if (occupied_at(grid, from_W) || occupied_at(grid, to_W)) return infinite;
  std::vector<double> cost(grid.cells.size(), infinite);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto index = [&](int i, int j) { return static_cast<std::size_t>(j) * grid.columns + i; };
  cost[index(from.x(), from.y())] = 0.0;
  open.push({0.0, index(from.x(), from.y())});
  while (!open.empty()) {
    const auto [so_far, at] = open.top();
    open.pop();
    if (so_far > cost[at]) continue;
    const int i = static_cast<int>(at % grid.columns), j = static_cast<int>(at / grid.columns);
    if (i == to.x() && j == to.y()) return so_far * grid.cell_m;
    for (int di = -1; di <= 1; ++di) {
      for (int dj = -1; dj <= 1; ++dj) {
        const int u = i + di, v = j + dj;
        if ((di == 0 && dj == 0) || u < 0 || v < 0 || u >= grid.columns || v >= grid.rows) continue;
        if (grid.occupied(u, v)) continue;
        const double next = so_far + (di != 0 && dj != 0 ? std::sqrt(2.0) : 1.0);
        if (next >= cost[index(u, v)]) continue;
        cost[index(u, v)] = next;
        open.push({next, index(u, v)});
      }
    }
  }
  return infinite;
}

/// Straight rows along x, the first at y = 0, in a box with margins.
/// @param bearing_rad  everything is turned by this about the origin
inline RowMap straight_map(int rows, double length_m, double pitch_m, double headland_m,
                           double canopy_m = 0.55, double bearing_rad = 0.0) {
  const Eigen::Rotation2Dd turn(bearing_rad);
  const auto at = [&](double x, double y) -> Eigen::Vector2d {
    return turn * Eigen::Vector2d(x, y);
  };
  const auto line = [&](double y) {
    const Eigen::Vector2d a = at(0, y), b = at(length_m, y);
    return std::vector<Eigen::Vector3d>{{a.x(), a.y(), 0.0}, {b.x(), b.y(), 0.0}};
  };
  RowMap map;
  for (int k = 0; k < rows; ++k) {
    map.rows.push_back({k, line(k * pitch_m), canopy_m, 0.5, 2.0});
    if (k > 0) map.alleys.push_back({k - 1, line((k - 0.5) * pitch_m), pitch_m});
  }
  const double top = (rows - 1) * pitch_m + pitch_m;
  map.boundary_W = {at(-headland_m, -pitch_m), at(length_m + headland_m, -pitch_m),
                    at(length_m + headland_m, top), at(-headland_m, top)};
  return map;
}

}  // namespace vinerow::test
