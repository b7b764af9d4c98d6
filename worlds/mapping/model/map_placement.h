#pragma once
/// Where a map lies that is not quite where the vineyard is: shift, turn and scale of everything.

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

/// Rows, alleys, parcel and occupancy grid. A grid that is turned or scaled is drawn anew in
/// squares of the same size: taken where the nearest old square or one beside it within half a
/// square is.
void place_rows(const MapPlacement& placement, RowMap& map);

}  // namespace vinerow::mapping
