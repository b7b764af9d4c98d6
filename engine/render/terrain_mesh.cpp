#include "engine/render/terrain_mesh.h"

#include <algorithm>
#include <cmath>

#include "engine/api/height_field.h"
#include "engine/render/noise.h"

namespace vinerow::render {

namespace {

constexpr int kSide = kChunkCells + 1;

GpuVertex ground_vertex(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
  GpuVertex vertex{};
  const Eigen::Vector3d n = normal.normalized();
  for (int c = 0; c < 3; ++c) {
    vertex.position[c] = static_cast<float>(p[c]);
    vertex.normal[c] = static_cast<std::int8_t>(std::lround(n[c] * 127.0));
    vertex.colour[c] = 255;
  }
  return vertex;
}

/// Vertex index of step k (0 .. 4 * kChunkCells) around the chunk's edge, counter-clockwise.
std::uint32_t edge_vertex(int k) {
  const int side = (k / kChunkCells) % 4;
  const int i = k % kChunkCells;
  switch (side) {
    case 0:
      return static_cast<std::uint32_t>(i);
    case 1:
      return static_cast<std::uint32_t>(i * kSide + kChunkCells);
    case 2:
      return static_cast<std::uint32_t>(kChunkCells * kSide + kChunkCells - i);
    default:
      return static_cast<std::uint32_t>((kChunkCells - i) * kSide);
  }
}

}  // namespace

PreparedMesh make_terrain_chunk(const HeightField& field, int column, int row) {
  PreparedMesh mesh;
  const auto height = [&](int i, int j) {
    i = std::clamp(i, 0, field.columns - 1);
    j = std::clamp(j, 0, field.rows - 1);
    return static_cast<double>(field.heights_m[static_cast<std::size_t>(j) * field.columns + i]);
  };
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const int gi = std::min(column * kChunkCells + i, field.columns - 1);
      const int gj = std::min(row * kChunkCells + j, field.rows - 1);
      const Eigen::Vector3d p(field.corner_W.x() + gi * field.cell_m,
                              field.corner_W.y() + gj * field.cell_m, height(gi, gj));
      const int gi_low = std::max(gi - 1, 0);
      const int gi_high = std::min(gi + 1, field.columns - 1);
      const int gj_low = std::max(gj - 1, 0);
      const int gj_high = std::min(gj + 1, field.rows - 1);
      const double slope_x =
          (height(gi_high, gj) - height(gi_low, gj)) / ((gi_high - gi_low) * field.cell_m);
      const double slope_y =
          (height(gi, gj_high) - height(gi, gj_low)) / ((gj_high - gj_low) * field.cell_m);
      mesh.vertices.push_back(ground_vertex(p, {-slope_x, -slope_y, 1.0}));
      mesh.bounds_M.extend(p);
    }
  }
  const double depth = 0.3 + 0.3 * field.cell_m;
  for (int k = 0; k < 4 * kChunkCells; ++k) {
    GpuVertex vertex = mesh.vertices[edge_vertex(k)];
    vertex.position[2] -= static_cast<float>(depth);
    mesh.vertices.push_back(vertex);
  }
  return mesh;
}

std::vector<std::uint32_t> make_chunk_indices(int level) {
  const int stride = 1 << level;
  std::vector<std::uint32_t> indices;
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(j * kSide + i); };
  for (int j = 0; j < kChunkCells; j += stride) {
    for (int i = 0; i < kChunkCells; i += stride) {
      const std::uint32_t a = at(i, j);
      const std::uint32_t b = at(i + stride, j);
      const std::uint32_t c = at(i + stride, j + stride);
      const std::uint32_t d = at(i, j + stride);
      indices.insert(indices.end(), {a, b, c, a, c, d});
    }
  }
  const std::uint32_t skirt = kSide * kSide;
  for (int k = 0; k < 4 * kChunkCells; k += stride) {
    const int next = (k + stride) % (4 * kChunkCells);
    const std::uint32_t a = edge_vertex(k);
    const std::uint32_t b = edge_vertex(next);
    const std::uint32_t below_a = skirt + static_cast<std::uint32_t>(k);
    const std::uint32_t below_b = skirt + static_cast<std::uint32_t>(next);
    indices.insert(indices.end(), {a, below_a, below_b, a, below_b, b});
  }
  return indices;
}

int pick_terrain_level(double seen_distance_m, double cell_m) {
  int level = 0;
  double limit = 70.0 * cell_m;
  while (level < kTerrainLevels - 1 && seen_distance_m > limit) {
    ++level;
    limit *= 2.0;
  }
  return level;
}

std::vector<PreparedMesh> make_surroundings(const Eigen::AlignedBox2d& rectangle,
                                            const HeightField* field, double level_height_m) {
  // Distances of the rings from the border.
  constexpr double kRings[] = {0,   2,   5,   10,  20,   35,   60,   100,  160,
                               250, 380, 560, 800, 1150, 1600, 2100, 2700, 3400};
  constexpr int kRingCount = sizeof(kRings) / sizeof(kRings[0]);
  constexpr int kPerSide = 96;
  const Eigen::Vector2d centre = rectangle.center();
  const Eigen::Vector2d half = 0.5 * rectangle.sizes();

  double mean = level_height_m;
  if (field != nullptr) {
    mean = 0.0;
    for (const float h : field->heights_m) mean += h / static_cast<double>(field->heights_m.size());
  }
  const auto height = [&](const Eigen::Vector2d& p, double away) {
    const double edge = field != nullptr ? field->height_m(p.x(), p.y()) : level_height_m;
    const double share = std::clamp((away - 15.0) / 500.0, 0.0, 1.0);
    const double blend = share * share * (3.0 - 2.0 * share);
    // Long ridges with finer shapes on them.
    const double shape = tiled_fbm(static_cast<float>(p.x() / 9000.0 + 0.37),
                                   static_cast<float>(p.y() / 9000.0 + 0.59), 9, 4, 91);
    const double hills = (shape - 0.40) * 0.14 * std::max(0.0, away - 60.0);
    return edge + blend * (mean - edge) + hills * blend;
  };
  const auto on_ring = [&](int step, double away) {
    // Around the rectangle, with the same share of each side on every ring.
    const int side = (step / kPerSide) % 4;
    const double s = 2.0 * (step % kPerSide) / kPerSide - 1.0;
    const double hx = half.x() + away;
    const double hy = half.y() + away;
    switch (side) {
      case 0:
        return Eigen::Vector2d(centre + Eigen::Vector2d(s * hx, -hy));
      case 1:
        return Eigen::Vector2d(centre + Eigen::Vector2d(hx, s * hy));
      case 2:
        return Eigen::Vector2d(centre + Eigen::Vector2d(-s * hx, hy));
      default:
        return Eigen::Vector2d(centre + Eigen::Vector2d(-hx, -s * hy));
    }
  };
  const auto vertex_at = [&](int step, int ring) {
    const Eigen::Vector2d p = on_ring(step, kRings[ring]);
    const double reach = 1.0 + 0.05 * kRings[ring];
    const double away = kRings[ring];
    const double slope_x = (height(p + Eigen::Vector2d(reach, 0), away) -
                            height(p - Eigen::Vector2d(reach, 0), away)) /
                           (2.0 * reach);
    const double slope_y = (height(p + Eigen::Vector2d(0, reach), away) -
                            height(p - Eigen::Vector2d(0, reach), away)) /
                           (2.0 * reach);
    return ground_vertex({p.x(), p.y(), height(p, away)}, {-slope_x, -slope_y, 1.0});
  };

  std::vector<PreparedMesh> sectors;
  constexpr int kPerSector = kPerSide / 2;
  for (int sector = 0; sector < 8; ++sector) {
    PreparedMesh mesh;
    for (int ring = 0; ring < kRingCount; ++ring) {
      for (int k = 0; k <= kPerSector; ++k) {
        mesh.vertices.push_back(vertex_at(sector * kPerSector + k, ring));
        const float* p = mesh.vertices.back().position;
        mesh.bounds_M.extend(Eigen::Vector3d(p[0], p[1], p[2]));
      }
    }
    for (int ring = 0; ring + 1 < kRingCount; ++ring) {
      for (int k = 0; k < kPerSector; ++k) {
        const auto a = static_cast<std::uint32_t>(ring * (kPerSector + 1) + k);
        const std::uint32_t b = a + kPerSector + 1;
        mesh.indices.insert(mesh.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
      }
    }
    sectors.push_back(std::move(mesh));
  }
  return sectors;
}

}  // namespace vinerow::render
