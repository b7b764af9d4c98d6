#pragma once
/// Plain data about a vineyard, shared by the true world and by the maps that vehicles are told.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace vinerow {

/// A plant row: its centre line at ground level and the canopy's cross-section.
struct PlantRow {
  int id = 0;
  std::vector<Eigen::Vector3d> line_W;  ///< >= 2 points, m, from one end to the other
  double canopy_width_m = 0.6;
  double canopy_base_m = 0.5;  ///< lowest leaves above ground
  double canopy_top_m = 2.0;
};

/// The free strip between two neighbouring rows (or beside the first and last), with its centre
/// line.
struct Alley {
  int id = 0;
  std::vector<Eigen::Vector3d> line_W;  ///< >= 2 points, m
  double width_m = 2.5;                 ///< between the rows' centre lines
};

/// What guidance and estimators know of the world.
struct RowMap {
  std::vector<PlantRow> rows;
  std::vector<Alley> alleys;                ///< in driving order across the block
  std::vector<Eigen::Vector2d> boundary_W;  ///< parcel polygon, counter-clockwise, or empty
};

}  // namespace vinerow
