#include "worlds/mapping/model/map_placement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vinerow::mapping {
namespace {

OccupancyGrid place_grid(const MapPlacement& placement, const OccupancyGrid& old) {
  OccupancyGrid grid = old;
  if (placement.turn_rad == 0.0 && placement.scale == 1.0) {
    grid.corner_W += placement.shift_m.head<2>();
    return grid;
  }
  const Eigen::Vector2d size = old.cell_m * Eigen::Vector2d(old.columns, old.rows);
  Eigen::AlignedBox2d box;
  for (const double x : {0.0, size.x()}) {
    for (const double y : {0.0, size.y()}) {
      box.extend(placement(Eigen::Vector2d(old.corner_W + Eigen::Vector2d(x, y))));
    }
  }
  grid.corner_W = box.min();
  grid.columns = static_cast<int>(std::ceil(box.sizes().x() / old.cell_m));
  grid.rows = static_cast<int>(std::ceil(box.sizes().y() / old.cell_m));
  grid.cells.assign(static_cast<std::size_t>(grid.columns) * grid.rows, 1);
  const Eigen::Rotation2Dd back(-placement.turn_rad);
  const Eigen::Vector2d middle = placement.middle_W.head<2>();
  const Eigen::Vector2d moved_middle = middle + placement.shift_m.head<2>();
  const auto is_occupied = [&](double x, double y) {
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    return i < 0 || j < 0 || i >= old.columns || j >= old.rows || old.occupied(i, j);
  };
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const Eigen::Vector2d centre = grid.corner_W + old.cell_m * Eigen::Vector2d(i + 0.5, j + 0.5);
      const Eigen::Vector2d there = back * (centre - moved_middle) / placement.scale + middle;
      const Eigen::Vector2d at = (there - old.corner_W) / old.cell_m;
      bool any = false;
      for (const double dx : {-0.5, 0.5}) {
        for (const double dy : {-0.5, 0.5}) any = any || is_occupied(at.x() + dx, at.y() + dy);
      }
      grid.cells[static_cast<std::size_t>(j) * grid.columns + i] = any;
    }
  }
  return grid;
}

}  // namespace

Eigen::Vector3d MapPlacement::operator()(const Eigen::Vector3d& p_W) const {
  const Eigen::AngleAxisd turn(turn_rad, Eigen::Vector3d::UnitZ());
  return middle_W + shift_m + scale * (turn * (p_W - middle_W));
}

Eigen::Vector2d MapPlacement::operator()(const Eigen::Vector2d& p_W) const {
  return (*this)(Eigen::Vector3d(p_W.x(), p_W.y(), middle_W.z())).head<2>();
}

Eigen::Vector3d middle_of(const std::vector<PlantRow>& rows) {
  Eigen::AlignedBox3d box;
  for (const PlantRow& row : rows) {
    for (const Eigen::Vector3d& p : row.line_W) box.extend(p);
  }
  return box.center();
}

void place_meshes(const MapPlacement& placement, std::vector<RowMesh>& meshes) {
  for (RowMesh& mesh : meshes) {
    for (Eigen::Vector3f& v : mesh.mesh_W.vertices) {
      v = placement(Eigen::Vector3d(v.cast<double>())).cast<float>();
    }
  }
}

void place_rows(const MapPlacement& placement, RowMap& map) {
  for (PlantRow& row : map.rows) {
    for (Eigen::Vector3d& p : row.line_W) p = placement(p);
  }
  for (Alley& alley : map.alleys) {
    for (Eigen::Vector3d& p : alley.line_W) p = placement(p);
    alley.width_m *= placement.scale;
  }
  for (Eigen::Vector2d& p : map.boundary_W) p = placement(p);
  if (!map.occupancy.empty()) map.occupancy = place_grid(placement, map.occupancy);
}

}  // namespace vinerow::mapping
