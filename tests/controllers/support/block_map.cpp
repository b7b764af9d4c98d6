#include "tests/controllers/support/block_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vinerow::test {

using Vec = Eigen::Vector2d;

Vec block_point(const BlockSetup& setup, double x, double y) {
  return Eigen::Rotation2Dd(setup.turned_rad) * Vec(x, y + setup.slant * x);
}

void mark(OccupancyGrid& grid, const Vec& a, const Vec& b, double half_width_m) {
  // A cell touches the rectangle unless one of the four axes parts them.
  const Vec middle = 0.5 * (a + b), along = (b - a).normalized(), across(-along.y(), along.x());
  const double half_length_m = 0.5 * (b - a).norm(), half_cell_m = 0.5 * grid.cell_m;
  const double reach_m = half_cell_m * (std::abs(along.x()) + std::abs(along.y()));
  const Vec extent = half_length_m * along.cwiseAbs() + half_width_m * across.cwiseAbs();
  const Vec low = (middle - extent - grid.corner_W) / grid.cell_m;
  const Vec high = (middle + extent - grid.corner_W) / grid.cell_m;
  const int last_j = std::min(grid.rows - 1, static_cast<int>(high.y()) + 1);
  const int last_i = std::min(grid.columns - 1, static_cast<int>(high.x()) + 1);
  for (int j = std::max(0, static_cast<int>(low.y()) - 1); j <= last_j; ++j) {
    for (int i = std::max(0, static_cast<int>(low.x()) - 1); i <= last_i; ++i) {
      const Vec away = grid.corner_W + grid.cell_m * Vec(i + 0.5, j + 0.5) - middle;
      if (std::abs(away.x()) > extent.x() + half_cell_m ||
          std::abs(away.y()) > extent.y() + half_cell_m ||
          std::abs(away.dot(along)) > half_length_m + reach_m ||
          std::abs(away.dot(across)) > half_width_m + reach_m) {
        continue;
      }
      grid.cells[static_cast<std::size_t>(j) * grid.columns + i] = 1;
    }
  }
}

RowMap make_block(const BlockSetup& setup) {
  RowMap map;
  const auto at = [&](double x, double y) { return block_point(setup, x, y); };
  const auto lift = [](const Vec& p) { return Eigen::Vector3d(p.x(), p.y(), 0.0); };
  for (int i = 0; i <= setup.alleys; ++i) {
    const double x = setup.spacing_m * i;
    PlantRow row;
    row.id = i;
    row.canopy_width_m = setup.canopy_m;
    row.line_W = {lift(at(x, 0.0)), lift(at(x, setup.row_length_m))};
    map.rows.push_back(row);
  }
  for (int i = 0; i < setup.alleys; ++i) {
    const double x = setup.spacing_m * (i + 0.5);
    map.alleys.push_back({i, {lift(at(x, 0.0)), lift(at(x, setup.row_length_m))}, setup.spacing_m});
  }
  const double right = setup.spacing_m * setup.alleys + setup.side_m, left = -setup.side_m;
  const double low = -setup.headland_m, high = setup.row_length_m + setup.headland_m;
  map.boundary_W = {at(left, low), at(right, low), at(right, high), at(left, high)};

  Eigen::AlignedBox2d box;
  for (const Vec& corner : map.boundary_W) box.extend(corner);
  OccupancyGrid& grid = map.occupancy;
  grid.cell_m = setup.cell_m;
  grid.corner_W = box.min().array() - setup.cell_m;
  grid.columns = static_cast<int>(std::ceil(box.sizes().x() / setup.cell_m)) + 2;
  grid.rows = static_cast<int>(std::ceil(box.sizes().y() / setup.cell_m)) + 2;
  grid.cells.assign(static_cast<std::size_t>(grid.columns) * grid.rows, 0);
  for (std::size_t i = 0; i < map.boundary_W.size(); ++i) {
    mark(grid, map.boundary_W[i], map.boundary_W[(i + 1) % map.boundary_W.size()], 0.0);
  }
  for (int i = 0; i <= setup.alleys; ++i) {
    const double x = setup.spacing_m * i;
    mark(grid, at(x, 0.0), at(x, setup.row_length_m), 0.5 * setup.canopy_m);
    if (!setup.has_walls) continue;
    if (i % 2 == 0) mark(grid, at(x, setup.row_length_m), at(x, high), 0.0);
    if (i % 2 == 1) mark(grid, at(x, low), at(x, 0.0), 0.0);
  }
  return map;
}

VehicleDescription make_four_wheel_description(double min_turning_radius_m) {
  VehicleDescription description;
  description.type = "four_wheel_steering_rover";
  description.collision_half_extents_m = {0.75, 0.5, 0.2};
  description.footprint_B = {{0.95, -0.36}, {0.95, 0.36},   {0.75, 0.5},   {-0.75, 0.5},
                             {-0.95, 0.36}, {-0.95, -0.36}, {-0.75, -0.5}, {0.75, -0.5}};
  description.min_turning_radius_m = min_turning_radius_m;
  description.wheeled.emplace();
  return description;
}

}  // namespace vinerow::test
