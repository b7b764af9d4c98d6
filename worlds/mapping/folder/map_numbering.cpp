#include "worlds/mapping/folder/map_numbering.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/api/map.h"
#include "worlds/mapping/grid/occupancy.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;

/// Mean direction of the lines.
Vector2d along_of(const std::vector<PlantRow>& rows) {
  Vector2d sum(0, 0);
  for (const PlantRow& row : rows) {
    sum += (row.line_W.back() - row.line_W.front()).head<2>().normalized();
  }
  return sum;
}

/// From the first row's middle to the last one's.
Vector2d across_of(const std::vector<PlantRow>& rows) {
  const auto middle = [](const PlantRow& row) {
    return Vector2d(0.5 * (row.line_W.front() + row.line_W.back()).head<2>());
  };
  return middle(rows.back()) - middle(rows.front());
}

std::vector<VirtualWall> walls_of(const RowMap& map) {
  return plan_occupancy(map, OccupancyOptions{}).walls;
}

/// Most of every wall's middle half is taken: free cells there mean that there is no wall.
bool holds_walls(const OccupancyGrid& grid, const std::vector<VirtualWall>& walls) {
  int occupied_count = 0, checked = 0;
  for (const VirtualWall& wall : walls) {
    for (double share = 0.25; share <= 0.75; share += 0.05) {
      const Vector2d at =
          (wall.from_W + share * (wall.to_W - wall.from_W) - grid.corner_W) / grid.cell_m;
      const int i = static_cast<int>(std::floor(at.x())), j = static_cast<int>(std::floor(at.y()));
      if (i < 0 || j < 0 || i >= grid.columns || j >= grid.rows) continue;
      ++checked;
      occupied_count += grid.occupied(i, j);
    }
  }
  return checked > 0 && occupied_count > 0.9 * checked;
}

bool same_places(const std::vector<VirtualWall>& a, const std::vector<VirtualWall>& b) {
  constexpr double kSame_m = 1e-6;
  return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const VirtualWall& wall) {
           return std::any_of(b.begin(), b.end(), [&](const VirtualWall& other) {
             return (wall.from_W - other.from_W).norm() < kSame_m &&
                    (wall.to_W - other.to_W).norm() < kSame_m;
           });
         });
}

}  // namespace

bool number_like(const RowMap& wanted, RowMap& map) {
  const bool turn = along_of(map.rows).dot(along_of(wanted.rows)) < 0.0;
  const bool reverse = across_of(map.rows).dot(across_of(wanted.rows)) < 0.0;
  if (!turn && !reverse) return false;
  const bool has_grid = !map.occupancy.empty() && map.boundary_W.size() >= 3;
  const std::vector<VirtualWall> old_walls = has_grid ? walls_of(map) : std::vector<VirtualWall>{};
  const bool had_walls = has_grid && holds_walls(map.occupancy, old_walls);
  if (turn) {
    for (PlantRow& row : map.rows) std::reverse(row.line_W.begin(), row.line_W.end());
    for (Alley& alley : map.alleys) std::reverse(alley.line_W.begin(), alley.line_W.end());
  }
  if (reverse) {
    std::reverse(map.rows.begin(), map.rows.end());
    std::reverse(map.alleys.begin(), map.alleys.end());
    std::map<int, int> numbers;
    for (std::size_t k = 0; k < map.rows.size(); ++k) {
      numbers[map.rows[k].id] = static_cast<int>(k);
      map.rows[k].id = static_cast<int>(k);
    }
    for (RowMesh& mesh : map.meshes) mesh.row = numbers.at(mesh.row);
    std::stable_sort(map.meshes.begin(), map.meshes.end(),
                     [](const RowMesh& a, const RowMesh& b) { return a.row < b.row; });
    for (std::size_t k = 0; k < map.alleys.size(); ++k) map.alleys[k].id = static_cast<int>(k);
  }
  if (had_walls && !same_places(old_walls, walls_of(map))) {
    OccupancyOptions options;
    options.cell_m = map.occupancy.cell_m;
    map.occupancy = make_occupancy_grid(map, options);
  }
  return true;
}

}  // namespace vinerow::mapping
