#include "tests/controllers/support/row_mesh_map.h"

#include <algorithm>
#include <cmath>

namespace vinerow::test {
namespace {

constexpr double kHeights_m[] = {0.5, 1.0, 1.5, 2.0};
constexpr double kRowHalfWidths_m[] = {0.24, 0.31, 0.29, 0.18};
constexpr std::uint32_t kRing = 8;

/// Corners of a section, counter-clockwise seen from the row's end: up the right side, down the
/// left.
void add_section(const RowMeshBlock& block, double along_m, double across_m, RandomStream& random,
                 TriangleMesh& mesh) {
  const double centre_m = across_m + block.centre_std_m * random.normal();
  const double wider_m = block.section_std_m * random.normal();
  const auto corner = [&](std::size_t level, double side) {
    const double half_m =
        std::max(0.02, kRowHalfWidths_m[level] + wider_m +
                           (block.section_std_m > 0.0 ? 0.03 : 0.0) * random.normal());
    const Eigen::Vector3d p = row_mesh_ground(block, along_m, centre_m + side * half_m);
    const Eigen::Vector3d foot = row_mesh_ground(block, along_m, across_m);
    mesh.vertices.push_back(
        Eigen::Vector3d(p.x(), p.y(), foot.z() + kHeights_m[level]).cast<float>());
  };
  for (std::size_t level = 0; level < 4; ++level) corner(level, -1.0);
  for (std::size_t level = 4; level-- > 0;) corner(level, 1.0);
}

}  // namespace

Eigen::Vector3d row_mesh_ground(const RowMeshBlock& block, double along_m, double across_m) {
  const double c = std::cos(block.azimuth_rad), s = std::sin(block.azimuth_rad);
  return {c * along_m - s * across_m, s * along_m + c * across_m,
          block.grade_along * along_m + block.grade_across * across_m};
}

RowMap make_row_mesh_map(const RowMeshBlock& block, RandomStream random) {
  RowMap map;
  for (int k = 0; k < block.rows; ++k) {
    const double across_m = k * block.pitch_m;
    PlantRow row;
    row.id = k;
    row.line_W = {row_mesh_ground(block, 0.0, across_m),
                  row_mesh_ground(block, block.length_m, across_m)};
    map.rows.push_back(row);
    if (k > 0) {
      Alley alley;
      alley.id = k - 1;
      alley.width_m = block.pitch_m;
      alley.line_W = {row_mesh_ground(block, 0.0, across_m - 0.5 * block.pitch_m),
                      row_mesh_ground(block, block.length_m, across_m - 0.5 * block.pitch_m)};
      map.alleys.push_back(alley);
    }

    RowMesh mesh;
    mesh.row = k;
    TriangleMesh& hull = mesh.mesh_W;
    for (double at_m = 0.0; at_m < block.length_m; at_m += random.uniform(1.0, 2.0)) {
      add_section(block, at_m, across_m, random, hull);
    }
    add_section(block, block.length_m, across_m, random, hull);
    const auto sections = static_cast<std::uint32_t>(hull.vertices.size()) / kRing;
    for (std::uint32_t i = 0; i + 1 < sections; ++i) {
      for (std::uint32_t n = 0; n < kRing; ++n) {
        const std::uint32_t a = i * kRing + n, b = i * kRing + (n + 1) % kRing;
        hull.triangles.push_back({a, a + kRing, b + kRing});
        hull.triangles.push_back({a, b + kRing, b});
      }
    }
    const std::uint32_t last = (sections - 1) * kRing;
    for (std::uint32_t n = 1; n + 1 < kRing; ++n) {
      hull.triangles.push_back({0, n, n + 1});
      hull.triangles.push_back({last, last + n + 1, last + n});
    }
    map.meshes.push_back(std::move(mesh));
  }
  return map;
}

}  // namespace vinerow::test
