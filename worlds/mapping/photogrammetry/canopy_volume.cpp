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

/// Intersection of a line across with a triangle: square of the line within a band, position, and
/// direction (in or out).
struct Crossing {
  double y;
  std::int32_t square;
  std::int32_t winding;
};

/// Sorts by square, then by position. There are a few in each square, of which many have some:
/// counting them takes a fraction of the time of a sort.
class Sorter {
 public:
  explicit Sorter(std::size_t squares) : begin_(squares + 1) {}

  const std::vector<Crossing>& sort(const std::vector<Crossing>& crossings) {
    std::fill(begin_.begin(), begin_.end(), 0u);
    for (const Crossing& crossing : crossings) ++begin_[square_of(crossing) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    next_ = begin_;
    sorted_.resize(crossings.size());
    for (const Crossing& crossing : crossings) sorted_[next_[square_of(crossing)]++] = crossing;
    for (std::size_t square = 0; square + 1 < begin_.size(); ++square) {
      std::sort(sorted_.begin() + begin_[square], sorted_.begin() + begin_[square + 1],
                [](const Crossing& a, const Crossing& b) { return a.y < b.y; });
    }
    return sorted_;
  }

 private:
  static std::size_t square_of(const Crossing& crossing) {
    return static_cast<std::size_t>(crossing.square);
  }
  std::vector<std::uint32_t> begin_, next_;
  std::vector<Crossing> sorted_;
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

struct CutTriangle {
  Corner corners[3];
  std::int64_t first;  ///< layer whose middle is not below it
  double top;
};

/// Squares of a side of the grid whose crossings are sorted together. Chosen.
constexpr std::int64_t kBandSquares = 1 << 15;

/// Adds where the lines across at height z meet the triangle. @param first_square  of the layer
void add_crossings(const CutTriangle& triangle, double z, double grid_m, std::int64_t columns,
                   std::int64_t first_square, std::vector<Crossing>& crossings) {
  // The triangle is cut from one edge that goes up through z to one that goes down.
  Vector2d up(0, 0), down(0, 0);
  bool is_cut = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner &a = triangle.corners[k], &b = triangle.corners[(k + 1) % 3];
    if ((a.z <= z) == (b.z <= z)) continue;
    is_cut = true;
    (a.z <= z ? up : down) = edge_at(a, b, z);
  }
  if (!is_cut) return;
  const Vector2d& from = up.x() < down.x() ? up : down;
  const Vector2d& to = up.x() < down.x() ? down : up;
  // s x z is -y: an edge up at the smaller s is a face that looks to +y, where a line goes out.
  const int winding = up.x() < down.x() ? 1 : -1;
  auto i = static_cast<std::int64_t>(std::ceil(from.x() / grid_m - 0.5));
  for (i = std::max<std::int64_t>(i, 0); i < columns; ++i) {
    const double s = (static_cast<double>(i) + 0.5) * grid_m;
    if (!(s < to.x())) break;
    const double share = (s - from.x()) / (to.x() - from.x());
    crossings.push_back({from.y() + share * (to.y() - from.y()),
                         static_cast<std::int32_t>(first_square + i), winding});
  }
}

/// Adds the lengths of lines inside, of squares whose lines go out as often as in.
void add_lengths_inside(const std::vector<Crossing>& crossings, double& inside_m) {
  for (std::size_t k = 0; k < crossings.size();) {
    int depth = 0;
    double length_m = 0.0;
    const std::int32_t square = crossings[k].square;
    for (; k < crossings.size() && crossings[k].square == square; ++k) {
      if (depth != 0) length_m += crossings[k].y - crossings[k - 1].y;
      depth += crossings[k].winding;
    }
    if (depth == 0) inside_m += length_m;
  }
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
  std::vector<CutTriangle> cuts;
  std::int64_t layers = 0;
  for (const CanopyTriangle& triangle : triangles) {
    CutTriangle cut;
    double bottom = std::numeric_limits<double>::infinity(), top = -bottom;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& p = triangle[k];
      cut.corners[k] = {along_W.dot(p.head<2>()) - low_s, left_W.dot(p.head<2>()), p.z() - low_z};
      bottom = std::min(bottom, cut.corners[k].z);
      top = std::max(top, cut.corners[k].z);
    }
    cut.first =
        std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(bottom / grid_m - 0.5)), 0);
    cut.top = top;
    cuts.push_back(cut);
    layers = std::max(layers, static_cast<std::int64_t>(top / grid_m + 0.5) + 1);
  }
  // Layer by layer, some together: all crossings of a long row would take a hundred megabytes.
  const std::int64_t together = std::max<std::int64_t>(1, kBandSquares / columns);
  Sorter sorter(static_cast<std::size_t>(together * columns));
  std::vector<Crossing> crossings;
  double inside_m = 0.0;
  for (std::int64_t begin = 0; begin < layers; begin += together) {
    crossings.clear();
    for (const CutTriangle& cut : cuts) {
      for (std::int64_t j = std::max(cut.first, begin); j < begin + together; ++j) {
        const double z = (static_cast<double>(j) + 0.5) * grid_m;
        if (!(z < cut.top)) break;
        add_crossings(cut, z, grid_m, columns, (j - begin) * columns, crossings);
      }
    }
    add_lengths_inside(sorter.sort(crossings), inside_m);
  }
  return inside_m * grid_m * grid_m;
}

}  // namespace vinerow::mapping
