#pragma once
/// Displacement of a map from the vineyard: shift, rotation and scale of everything.

#include <vector>

#include "engine/api/map.h"

namespace vinerow::mapping {

/// p -> middle + shift + scale * R(turn about the vertical) * (p - middle).
struct MapPlacement {
  Eigen::Vector3d middle_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  ///< east, north, up
  double turn_rad = 0.0;
  double scale = 1.0;

  bool moves() const { return !shift_m.isZero(0.0) || turn_rad != 0.0 || scale != 1.0; }
  Eigen::Vector3d operator()(const Eigen::Vector3d& p_W) const;
  Eigen::Vector2d operator()(const Eigen::Vector2d& p_W) const;
};

/// Middle of the box around the rows.
Eigen::Vector3d middle_of(const std::vector<PlantRow>& rows);

void place_meshes(const MapPlacement& placement, std::vector<RowMesh>& meshes);

/// Rows, alleys, parcel and occupancy grid. A grid that is rotated or scaled is resampled with
/// cells of the same size: a cell is occupied if the nearest old cell is, or one next to it within
/// half a cell.
void place_rows(const MapPlacement& placement, RowMap& map);

}  // namespace vinerow::mapping
