#include "worlds/mapping/photogrammetry/canopy_volume.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "engine/api/map.h"
#include "engine/api/mesh.h"
#include "engine/api/surface.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/math/polyline_index.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Connected components of vertices by triangles.
std::vector<std::uint32_t> find_pieces(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> leader(mesh.vertices.size());
  std::iota(leader.begin(), leader.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (leader[v] != v) v = leader[v] = leader[leader[v]];
    return v;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const std::uint32_t v : {b, c}) {
      const std::uint32_t first = find(a), other = find(v);
      leader[std::max(first, other)] = std::min(first, other);
    }
  }
  for (std::uint32_t v = 0; v < leader.size(); ++v) leader[v] = find(v);
  return leader;
}

/// Intersection of a line across with a triangle: square of the line, position, and direction (in
/// or out).
struct Crossing {
  std::int64_t square;
  double y;
  int winding;
  bool operator<(const Crossing& other) const {
    return square != other.square ? square < other.square : y < other.y;
  }
};

struct Corner {
  double s, y, z;
};

/// Of an edge at height z, always counted from its lower end, so that two triangles that share it
/// agree to the bit.
Vector2d edge_at(const Corner& a, const Corner& b, double z) {
  const Corner& low = a.z < b.z ? a : b;
  const Corner& high = a.z < b.z ? b : a;
  const double share = (z - low.z) / (high.z - low.z);
  return {low.s + share * (high.s - low.s), low.y + share * (high.y - low.y)};
}

}  // namespace

std::vector<std::vector<CanopyTriangle>> canopy_by_row(const WorldModel& world, double reach_m) {
  std::vector<Polyline> lines;
  for (const PlantRow& row : world.rows->rows) lines.emplace_back(from_above(row.line_W));
  const PolylineIndex rows(std::move(lines));
  std::vector<std::vector<CanopyTriangle>> canopy(rows.lines().size());
  for (const MeshInstance& instance : world.meshes) {
    if (!instance.collides || instance.surface != SurfaceClass::kCanopy || !instance.mesh) continue;
    const TriangleMesh& mesh = *instance.mesh;
    const std::vector<std::uint32_t> piece = find_pieces(mesh);
    std::vector<Vector2d> sum(piece.size(), Vector2d::Zero());
    std::vector<int> count(piece.size(), 0), row_of(piece.size(), -1);
    std::vector<Vector3d> vertices;
    for (std::size_t v = 0; v < piece.size(); ++v) {
      vertices.push_back(instance.X_WM * mesh.vertices[v].cast<double>());
      sum[piece[v]] += vertices[v].head<2>();
      ++count[piece[v]];
    }
    for (std::size_t v = 0; v < piece.size(); ++v) {
      if (piece[v] != v) continue;
      const PolylineIndex::Nearest nearest = rows.nearest(sum[v] / count[v]);
      if (nearest.distance_m <= reach_m) row_of[v] = nearest.line;
    }
    for (const auto& [a, b, c] : mesh.triangles) {
      const int row = row_of[piece[a]];
      if (row >= 0) {
        canopy[static_cast<std::size_t>(row)].push_back({vertices[a], vertices[b], vertices[c]});
      }
    }
  }
  return canopy;
}

double enclosed_volume_m3(const std::vector<CanopyTriangle>& triangles, const Vector2d& along_W,
                          double grid_m) {
  VINEROW_DEMAND(grid_m > 0.0);
  if (triangles.empty()) return 0.0;
  const Vector2d left_W(-along_W.y(), along_W.x());
  double low_s = std::numeric_limits<double>::infinity(), high_s = -low_s, low_z = low_s;
  for (const CanopyTriangle& triangle : triangles) {
    for (const Vector3d& p : triangle) {
      low_s = std::min(low_s, along_W.dot(p.head<2>()));
      high_s = std::max(high_s, along_W.dot(p.head<2>()));
      low_z = std::min(low_z, p.z());
    }
  }
  const auto columns = static_cast<std::int64_t>((high_s - low_s) / grid_m) + 1;
  std::vector<Crossing> crossings;
  for (const CanopyTriangle& triangle : triangles) {
    Corner corners[3];
    double bottom = std::numeric_limits<double>::infinity(), top = -bottom;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& p = triangle[k];
      corners[k] = {along_W.dot(p.head<2>()) - low_s, left_W.dot(p.head<2>()), p.z() - low_z};
      bottom = std::min(bottom, corners[k].z);
      top = std::max(top, corners[k].z);
    }
    auto j = static_cast<std::int64_t>(std::ceil(bottom / grid_m - 0.5));
    for (j = std::max<std::int64_t>(j, 0); (static_cast<double>(j) + 0.5) * grid_m < top; ++j) {
      const double z = (static_cast<double>(j) + 0.5) * grid_m;
      // The triangle is cut from one edge that goes up through z to one that goes down.
      Vector2d up(0, 0), down(0, 0);
      bool is_cut = false;
      for (std::size_t k = 0; k < 3; ++k) {
        const Corner &a = corners[k], &b = corners[(k + 1) % 3];
        if ((a.z <= z) == (b.z <= z)) continue;
        is_cut = true;
        (a.z <= z ? up : down) = edge_at(a, b, z);
      }
      if (!is_cut) continue;
      const Vector2d& from = up.x() < down.x() ? up : down;
      const Vector2d& to = up.x() < down.x() ? down : up;
      // s x z is -y: an edge up at the smaller s is a face that looks to +y, where a line goes out.
      const int winding = up.x() < down.x() ? 1 : -1;
      auto i = static_cast<std::int64_t>(std::ceil(from.x() / grid_m - 0.5));
      for (i = std::max<std::int64_t>(i, 0); i < columns; ++i) {
        const double s = (static_cast<double>(i) + 0.5) * grid_m;
        if (!(s < to.x())) break;
        const double share = (s - from.x()) / (to.x() - from.x());
        crossings.push_back({j * columns + i, from.y() + share * (to.y() - from.y()), winding});
      }
    }
  }
  std::sort(crossings.begin(), crossings.end());
  double inside_m = 0.0;
  for (std::size_t k = 0; k < crossings.size();) {
    int depth = 0;
    double length_m = 0.0;
    const std::int64_t square = crossings[k].square;
    for (; k < crossings.size() && crossings[k].square == square; ++k) {
      if (depth != 0) length_m += crossings[k].y - crossings[k - 1].y;
      depth += crossings[k].winding;
    }
    if (depth == 0) inside_m += length_m;
  }
  return inside_m * grid_m * grid_m;
}

}  // namespace vinerow::mapping
