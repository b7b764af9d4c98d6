#pragma once
/// A map on which everything has a closed form: straight rows with plane upright walls on a plane.

#include <cmath>

#include "engine/api/map.h"

namespace vinerow::test {

struct WallBlock {
  int rows = 2;
  double pitch_m = 2.5;
  double half_width_m = 0.25;
  double from_m = -5.0, to_m = 60.0;  ///< along x
  double top_m = 2.0;                 ///< above ground, where the walls begin
  double grade_along = 0.0, grade_across = 0.0;
};

/// Ground of the block: a plane through W's origin.
inline double wall_ground_m(const WallBlock& block, double x, double y) {
  return block.grade_along * x + block.grade_across * y;
}
/// Of that plane, upwards.
inline Eigen::Vector3d wall_ground_normal(const WallBlock& block) {
  return Eigen::Vector3d(-block.grade_along, -block.grade_across, 1.0).normalized();
}

/// Row k stands along x at y = k pitch; what its maker states of errors is zero.
inline RowMap make_wall_map(const WallBlock& block) {
  RowMap map;
  map.accuracy.surface_std_m = 0.0;
  map.accuracy.correlation_length_m = 0.0;
  const auto ground = [&](double x, double y) {
    return Eigen::Vector3d(x, y, wall_ground_m(block, x, y));
  };
  for (int k = 0; k < block.rows; ++k) {
    const double y = k * block.pitch_m;
    PlantRow row;
    row.id = k;
    row.line_W = {ground(block.from_m, y), ground(block.to_m, y)};
    map.rows.push_back(row);
    if (k > 0) {
      const double middle = y - 0.5 * block.pitch_m;
      map.alleys.push_back(
          {k - 1, {ground(block.from_m, middle), ground(block.to_m, middle)}, block.pitch_m});
    }
    RowMesh mesh;
    mesh.row = k;
    for (const double x : {block.from_m, block.to_m}) {
      // Up the right side, down the left one.
      for (const auto& [side, up_m] : {std::pair{-1.0, 0.0}, std::pair{-1.0, block.top_m},
                                       std::pair{1.0, block.top_m}, std::pair{1.0, 0.0}}) {
        Eigen::Vector3d p = ground(x, y) + Eigen::Vector3d(0, side * block.half_width_m, up_m);
        mesh.mesh_W.vertices.push_back(p.cast<float>());
      }
    }
    for (std::uint32_t n = 0; n < 4; ++n) {
      const std::uint32_t m = (n + 1) % 4;
      mesh.mesh_W.triangles.push_back({n, n + 4, m + 4});
      mesh.mesh_W.triangles.push_back({n, m + 4, m});
    }
    for (std::uint32_t n = 1; n < 3; ++n) {
      mesh.mesh_W.triangles.push_back({0, n, n + 1});
      mesh.mesh_W.triangles.push_back({4, n + 5, n + 4});
    }
    map.meshes.push_back(std::move(mesh));
  }
  return map;
}

}  // namespace vinerow::test
