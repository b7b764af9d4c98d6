#pragma once
/// Rows of plants and the alleys between them, as plain data.

#include <Eigen/Core>
#include <vector>

namespace vinerow {

/// Plant row: its centre line at ground level and the cross-section of its canopy.
struct PlantRow {
  int id = 0;
  std::vector<Eigen::Vector3d> line_W;  ///< >= 2 points, m, from one end to the other
  double canopy_width_m = 0.6;
  double canopy_base_m = 0.5;  ///< lowest leaves above ground
  double canopy_top_m = 2.0;
};

/// Free strip between two neighbouring rows (or next to the first and last), with its centre line.
struct Alley {
  int id = 0;
  std::vector<Eigen::Vector3d> line_W;  ///< >= 2 points, m
  double width_m = 2.5;                 ///< between the rows' centre lines
};

}  // namespace vinerow
