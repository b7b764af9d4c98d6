#pragma once
/// A map with row meshes after the world of paper C as its corrected reading settles it: rows on a
/// plane that rises along and across them, chains of cross-sections joined to closed hulls.

#include "engine/api/map.h"
#include "engine/core/random.h"

namespace vinerow::test {

struct RowMeshBlock {
  int rows = 16;
  double length_m = 118.0;
  double pitch_m = 2.5;
  double azimuth_rad = -0.5235987755982988;  ///< of the rows, counter-clockwise from east
  double grade_along = 0.18;
  double grade_across = 0.17;   ///< rise per metre to the left of the rows
  double section_std_m = 0.07;  ///< of a section's width; each level has 0.03 m more of its own
  double centre_std_m = 0.05;   ///< of a section's place across the row
};

/// Row k starts at k * pitch to the left of W's origin; sections every 1 to 2 m with half widths
/// 0.24, 0.31, 0.29, 0.18 m at 0.5, 1, 1.5, 2 m above the ground: 16 triangles for each.
RowMap make_row_mesh_map(const RowMeshBlock& block, RandomStream random);

/// Ground of the block. @param along_m,across_m  from W's origin
Eigen::Vector3d row_mesh_ground(const RowMeshBlock& block, double along_m, double across_m);

/// Of all meshes of a map.
inline std::size_t triangle_count(const RowMap& map) {
  std::size_t count = 0;
  for (const RowMesh& mesh : map.meshes) count += mesh.mesh_W.triangles.size();
  return count;
}

}  // namespace vinerow::test
