#include "tools/replay/replay_ground.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/render/terrain_mesh.h"
#include "tools/replay/replay_decimate.h"

namespace vinerow::tools {
namespace {

/// Cells along a side of one mesh: (200 + 1)^2 vertices fit 16-bit indices.
constexpr int kMaxCells = 200;

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

bool inside(const CellRange& range, int i, int j) {
  return i >= range.first.x() && j >= range.first.y() && i < range.last.x() && j < range.last.y();
}

/// Adds a curtain below one edge of the triangles; it hides the gap to the neighbouring mesh.
void add_curtain(render::PreparedMesh& mesh, std::uint32_t from, std::uint32_t to, double depth_m) {
  const auto below = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const std::uint32_t top : {from, to}) {
    render::GpuVertex vertex = mesh.vertices[top];
    vertex.position[2] -= static_cast<float>(depth_m);
    mesh.vertices.push_back(vertex);
  }
  mesh.indices.insert(mesh.indices.end(), {from, below, below + 1, from, below + 1, to});
}

}  // namespace

std::vector<render::PreparedMesh> terrain_meshes(const HeightField& field, const CellRange& hole) {
  std::vector<render::PreparedMesh> meshes;
  for (int j0 = 0; j0 < field.rows - 1; j0 += kMaxCells) {
    for (int i0 = 0; i0 < field.columns - 1; i0 += kMaxCells) {
      const int columns = std::min(kMaxCells, field.columns - 1 - i0);
      const int rows = std::min(kMaxCells, field.rows - 1 - j0);
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
      const auto is_there = [&](int i, int j) {
        return i >= 0 && j >= 0 && i < field.columns - 1 && j < field.rows - 1 &&
               !inside(hole, i, j);
      };
      for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
          if (inside(hole, i0 + i, j0 + j)) continue;
          const std::uint32_t corners[] = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
          mesh.indices.insert(mesh.indices.end(), {corners[0], corners[1], corners[2], corners[0],
                                                   corners[2], corners[3]});
          // South, east, north, west: counter-clockwise order makes curtains face outward.
          constexpr int kBeyond[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
          for (int side = 0; side < 4; ++side) {
            if (is_there(i0 + i + kBeyond[side][0], j0 + j + kBeyond[side][1])) continue;
            add_curtain(mesh, corners[side], corners[(side + 1) % 4], 0.5 + field.cell_m);
          }
        }
      }
      meshes.push_back(std::move(mesh));
    }
  }
  return meshes;
}

std::vector<render::PreparedMesh> surroundings_meshes(const HeightField& field) {
  const Eigen::AlignedBox2d box(
      field.corner_W,
      Eigen::Vector2d(field.corner_W + Eigen::Vector2d(field.width_m(), field.depth_m())));
  std::vector<render::PreparedMesh> meshes = render::make_surroundings(box, &field, 0.0);
  for (render::PreparedMesh& mesh : meshes) {
    const auto at_border = [&](std::uint32_t i) {
      const Eigen::Vector2d p(mesh.vertices[i].position[0], mesh.vertices[i].position[1]);
      const Eigen::Array2d near_low = (p - box.min()).array().abs();
      const Eigen::Array2d near_high = (p - box.max()).array().abs();
      return std::min(near_low.minCoeff(), near_high.minCoeff()) < 1e-3 &&
             box.exteriorDistance(p) < 1e-3;
    };
    const std::size_t corners = mesh.indices.size();
    for (std::size_t k = 0; k < corners; ++k) {
      const std::uint32_t from = mesh.indices[k];
      const std::uint32_t to = mesh.indices[k % 3 == 2 ? k - 2 : k + 1];
      if (at_border(from) && at_border(to)) add_curtain(mesh, from, to, 0.5 + field.cell_m);
    }
  }
  return meshes;
}

ReplayTerrain thin_terrain(const HeightField& field, const Eigen::AlignedBox2d& focus_W,
                           int max_samples) {
  ReplayTerrain terrain;
  if (stride_for(field, max_samples) == 1) {
    terrain.coarse = field;
    return terrain;
  }
  // A third of the samples for the country, two thirds for the focus. The stride is a power of two,
  // so that the fine stride divides it.
  const int stride = static_cast<int>(
      std::bit_ceil(static_cast<unsigned>(stride_for(field, std::max(max_samples / 3, 9)))));
  terrain.coarse = thin_height_field(field, stride);
  if (focus_W.isEmpty()) return terrain;
  // The fine field starts and ends at samples of the coarse one, so that no cells overlap.
  const auto cell_of = [&](const Eigen::Vector2d& p_W, bool up) {
    const Eigen::Array2d share = (p_W - field.corner_W).array() / terrain.coarse.cell_m;
    const Eigen::Array2d whole = up ? Eigen::Array2d(share.ceil()) : Eigen::Array2d(share.floor());
    const Eigen::Array2d max_index((field.columns - 1) / stride, (field.rows - 1) / stride);
    return Eigen::Vector2i(whole.max(0.0).min(max_index).matrix().cast<int>());
  };
  terrain.hole = {cell_of(focus_W.min(), false), cell_of(focus_W.max(), true)};
  if ((terrain.hole.last - terrain.hole.first).minCoeff() < 1) {
    terrain.hole = {};
    return terrain;
  }
  const HeightField whole =
      crop_height_field(field, stride * terrain.hole.first, stride * terrain.hole.last);
  const int fine = static_cast<int>(
      std::bit_ceil(static_cast<unsigned>(stride_for(whole, std::max(2 * max_samples / 3, 9)))));
  if (fine >= stride) {
    terrain.hole = {};
    return terrain;
  }
  terrain.fine = thin_height_field(whole, fine);
  return terrain;
}

}  // namespace vinerow::tools
