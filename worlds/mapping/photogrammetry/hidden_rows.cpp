#include "worlds/mapping/photogrammetry/hidden_rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"

namespace vinerow::mapping {
namespace {

void check_row(const WorldModel& world, int row) {
  const std::vector<PlantRow>& rows = world.rows->rows;
  const auto is_it = [row](const PlantRow& plants) { return plants.id == row; };
  if (std::any_of(rows.begin(), rows.end(), is_it)) return;
  if (rows.empty()) throw ConfigError(fmt::format("world '{}' has no rows", world.name));
  const auto [first, last] = std::minmax_element(
      rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  throw ConfigError(fmt::format("world '{}' has no row {}, its rows are {} to {}", world.name, row,
                                first->id, last->id));
}

}  // namespace

HiddenRows::HiddenRows(const WorldModel& world, const std::vector<int>& hidden) {
  for (const int row : hidden) check_row(world, row);
  if (hidden.empty()) return;
  std::vector<Polyline> lines;
  for (const PlantRow& row : world.rows->rows) {
    lines.emplace_back(from_above(row.line_W));
    hidden_.push_back(std::find(hidden.begin(), hidden.end(), row.id) != hidden.end());
  }
  rows_ = PolylineIndex(std::move(lines));
}

bool HiddenRows::hide(const Eigen::Vector3d& p_W, PointClass truth) const {
  if (truth != PointClass::kCanopy) return false;
  const int nearest = rows_.nearest(p_W.head<2>()).line;
  return nearest >= 0 && hidden_[static_cast<std::size_t>(nearest)];
}

}  // namespace vinerow::mapping
