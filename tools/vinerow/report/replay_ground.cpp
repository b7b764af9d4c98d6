#include "tools/vinerow/report/replay_ground.h"

#include <algorithm>
#include <cmath>

namespace vinerow::tools {
namespace {

/// Cells along a side of one mesh.
constexpr int kMostCells = 200;

double height_at(const HeightField& field, int i, int j) {
  i = std::clamp(i, 0, field.columns - 1);
  j = std::clamp(j, 0, field.rows - 1);
  return field.heights_m[static_cast<std::size_t>(j) * field.columns + i];
}

render::GpuVertex vertex_at(const HeightField& field, int i, int j) {
  render::GpuVertex vertex{};
  vertex.position[0] = static_cast<float>(field.corner_W.x() + i * field.cell_m);
  vertex.position[1] = static_cast<float>(field.corner_W.y() + j * field.cell_m);
  vertex.position[2] = static_cast<float>(height_at(field, i, j));
  const double span_x = (std::min(i + 1, field.columns - 1) - std::max(i - 1, 0)) * field.cell_m;
  const double span_y = (std::min(j + 1, field.rows - 1) - std::max(j - 1, 0)) * field.cell_m;
  const Eigen::Vector3d normal =
      Eigen::Vector3d(-(height_at(field, i + 1, j) - height_at(field, i - 1, j)) / span_x,
                      -(height_at(field, i, j + 1) - height_at(field, i, j - 1)) / span_y, 1.0)
          .normalized();
  for (int c = 0; c < 3; ++c) {
    vertex.normal[c] = static_cast<std::int8_t>(std::lround(127.0 * normal[c]));
    vertex.colour[c] = 255;
  }
  return vertex;
}

/// A curtain below the outer edges hides cracks between the field and the country around it.
/// @param edges  which of south, east, north and west are outer ones
void add_skirts(render::PreparedMesh& mesh, int columns, int rows, const bool (&edges)[4],
                double depth_m) {
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int side = 0; side < 4; ++side) {
    if (!edges[side]) continue;
    const int steps = side % 2 == 0 ? columns : rows;
    for (int k = 0; k <= steps; ++k) {
      // Counter-clockwise around the mesh, so that the curtain faces outward.
      const std::uint32_t top = side == 0   ? at(k, 0)
                                : side == 1 ? at(columns, k)
                                : side == 2 ? at(columns - k, rows)
                                            : at(0, rows - k);
      const auto below = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(mesh.vertices[top]);
      mesh.vertices.back().position[2] -= static_cast<float>(depth_m);
      if (k == 0) continue;
      const std::uint32_t before = side == 0   ? at(k - 1, 0)
                                   : side == 1 ? at(columns, k - 1)
                                   : side == 2 ? at(columns - k + 1, rows)
                                               : at(0, rows - k + 1);
      mesh.indices.insert(mesh.indices.end(), {before, below - 1, below, before, below, top});
    }
  }
}

}  // namespace

std::vector<render::PreparedMesh> terrain_meshes(const HeightField& field) {
  std::vector<render::PreparedMesh> meshes;
  for (int j0 = 0; j0 < field.rows - 1; j0 += kMostCells) {
    for (int i0 = 0; i0 < field.columns - 1; i0 += kMostCells) {
      const int columns = std::min(kMostCells, field.columns - 1 - i0);
      const int rows = std::min(kMostCells, field.rows - 1 - j0);
      render::PreparedMesh mesh;
      for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
          mesh.vertices.push_back(vertex_at(field, i0 + i, j0 + j));
          mesh.bounds_M.extend(
              Eigen::Map<const Eigen::Vector3f>(mesh.vertices.back().position).cast<double>());
        }
      }
      const auto at = [&](int i, int j) {
        return static_cast<std::uint32_t>(j * (columns + 1) + i);
      };
      for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
          mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1),
                                                   at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
      }
      const bool edges[] = {j0 == 0, i0 + columns == field.columns - 1, j0 + rows == field.rows - 1,
                            i0 == 0};
      add_skirts(mesh, columns, rows, edges, 0.5 + field.cell_m);
      meshes.push_back(std::move(mesh));
    }
  }
  return meshes;
}

}  // namespace vinerow::tools
