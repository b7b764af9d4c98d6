#pragma once
/// Occupancy grids drawn by hand for tests and benchmarks of the planners, and a collision check
/// that shares nothing with the one under test: cells against polygon, one by one.

#include <cmath>
#include <vector>

#include "controllers/parts/paths/path_pieces.h"
#include "engine/api/messages/grid.h"

namespace vinerow::hand_grids {

inline OccupancyGrid make_free_grid(const Eigen::Vector2d& lower_W, const Eigen::Vector2d& upper_W,
                                    double cell_m = 0.05) {
  OccupancyGrid grid;
  grid.cell_m = cell_m;
  grid.corner_W = lower_W;
  grid.columns = static_cast<int>(std::lround((upper_W.x() - lower_W.x()) / cell_m));
  grid.rows = static_cast<int>(std::lround((upper_W.y() - lower_W.y()) / cell_m));
  grid.cells.assign(static_cast<std::size_t>(grid.columns) * grid.rows, 0);
  return grid;
}

/// Marks every cell whose centre lies in the rectangle; at least one cell wide.
inline void fill(OccupancyGrid& grid, double x0, double y0, double x1, double y1) {
  const auto first = [&](double v, double corner) {
    return static_cast<int>(std::ceil((v - corner) / grid.cell_m - 0.5 - 1e-9));
  };
  const auto last = [&](double v, double corner) {
    return static_cast<int>(std::floor((v - corner) / grid.cell_m - 0.5 + 1e-9));
  };
  const int i0 = std::max(0, first(x0, grid.corner_W.x()));
  const int i1 = std::min(grid.columns - 1, std::max(i0, last(x1, grid.corner_W.x())));
  const int j0 = std::max(0, first(y0, grid.corner_W.y()));
  const int j1 = std::min(grid.rows - 1, std::max(j0, last(y1, grid.corner_W.y())));
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) grid.cells[static_cast<std::size_t>(j) * grid.columns + i] = 1;
  }
}

/// Rows along x from 0 to length, alley k between y = 2.5 k - 1.25 and + 1.25, headlands of 8 m at
/// both ends, and the parcel closed all around. Paper A, section 3.1: with `walls`, virtual walls
/// lead from the row ends to the boundary, alternating, so that only the serpentine from alley 0,
/// driven in +x, is free.
struct Vineyard {
  double length_m = 30.0;
  int alleys = 2;
  bool walls = true;
  double canopy_m = 0.6;
  double headland_m = 8.0;

  double row_y(int row) const { return 2.5 * row - 1.25; }
  double alley_y(int alley) const { return 2.5 * alley; }

  OccupancyGrid make() const {
    const double side_m = 6.0, edge_m = 0.05;
    const double low = row_y(0) - side_m, high = row_y(alleys) + side_m;
    OccupancyGrid grid = make_free_grid({-headland_m, low}, {length_m + headland_m, high});
    for (int row = 0; row <= alleys; ++row) {
      const double y = row_y(row);
      fill(grid, 0.0, y - 0.5 * canopy_m, length_m, y + 0.5 * canopy_m);
      if (!walls) continue;
      // Outer rows are closed at both ends, the others away from their turn.
      const bool is_outer = row == 0 || row == alleys;
      if (is_outer || row % 2 == 0) fill(grid, length_m, y, length_m + headland_m, y);
      if (is_outer || row % 2 == 1) fill(grid, -headland_m, y, 0.0, y);
    }
    fill(grid, -headland_m, low, length_m + headland_m, low + edge_m);
    fill(grid, -headland_m, high - edge_m, length_m + headland_m, high);
    fill(grid, -headland_m, low, -headland_m + edge_m, high);
    fill(grid, length_m + headland_m - edge_m, low, length_m + headland_m, high);
    return grid;
  }

  bool drives_up(int alley) const { return alley % 2 == 0; }
  /// Where an alley is entered and left, heading along it.
  controllers::Pose2 entry(int alley) const {
    return drives_up(alley)
               ? controllers::Pose2{{0.0, alley_y(alley)}, 0.0}
               : controllers::Pose2{{length_m, alley_y(alley)}, 3.14159265358979323846};
  }
  controllers::Pose2 exit(int alley) const {
    return {{drives_up(alley) ? length_m : 0.0, alley_y(alley)}, entry(alley).yaw_rad};
  }
};

/// The rover of paper A: 1.5 x 1.0 m and the wheels' noses.
inline std::vector<Eigen::Vector2d> rover_outline_B() {
  return {{-0.95, -0.36}, {-0.75, -0.5}, {0.75, -0.5}, {0.95, -0.36},
          {0.95, 0.36},   {0.75, 0.5},   {-0.75, 0.5}, {-0.95, 0.36}};
}

/// True where the centre of an occupied cell lies inside the outline, or the outline leaves the
/// grid. @param outline_B  convex, counter-clockwise
inline bool touches(const OccupancyGrid& grid, const std::vector<Eigen::Vector2d>& outline_B,
                    const controllers::Pose2& pose) {
  std::vector<Eigen::Vector2d> outline_W;
  Eigen::Vector2d low = pose.p, high = pose.p;
  for (const Eigen::Vector2d& p : outline_B) {
    outline_W.push_back(
        pose.p + Eigen::Vector2d(std::cos(pose.yaw_rad) * p.x() - std::sin(pose.yaw_rad) * p.y(),
                                 std::sin(pose.yaw_rad) * p.x() + std::cos(pose.yaw_rad) * p.y()));
    low = low.cwiseMin(outline_W.back());
    high = high.cwiseMax(outline_W.back());
  }
  const Eigen::Vector2d from = (low - grid.corner_W) / grid.cell_m,
                        to = (high - grid.corner_W) / grid.cell_m;
  if (from.x() < 0 || from.y() < 0 || to.x() > grid.columns || to.y() > grid.rows) return true;
  for (int j = static_cast<int>(from.y()); j < to.y() && j < grid.rows; ++j) {
    for (int i = static_cast<int>(from.x()); i < to.x() && i < grid.columns; ++i) {
      if (!grid.occupied(i, j)) continue;
      const Eigen::Vector2d centre =
          grid.corner_W + grid.cell_m * Eigen::Vector2d(i + 0.5, j + 0.5);
      bool inside = true;
      for (std::size_t k = 0; k < outline_W.size() && inside; ++k) {
        const Eigen::Vector2d a = outline_W[k], ab = outline_W[(k + 1) % outline_W.size()] - a;
        inside = ab.x() * (centre.y() - a.y()) - ab.y() * (centre.x() - a.x()) > 0.0;
      }
      if (inside) return true;
    }
  }
  return false;
}

inline bool path_touches(const OccupancyGrid& grid, const std::vector<Eigen::Vector2d>& outline_B,
                         const std::vector<controllers::PathSegment>& pieces,
                         double step_m = 0.02) {
  for (const controllers::PathSegment& piece : pieces) {
    const int parts = std::max(1, static_cast<int>(std::ceil(piece.length_m / step_m)));
    for (int i = 0; i <= parts; ++i) {
      if (touches(grid, outline_B, piece.at(piece.length_m * i / parts))) return true;
    }
  }
  return false;
}

inline double length_m(const std::vector<controllers::PathSegment>& pieces) {
  double sum = 0.0;
  for (const controllers::PathSegment& piece : pieces) sum += piece.length_m;
  return sum;
}

}  // namespace vinerow::hand_grids
