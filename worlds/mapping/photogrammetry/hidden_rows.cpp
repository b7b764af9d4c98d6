#include "worlds/mapping/photogrammetry/hidden_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

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
  const auto [least, most] = std::minmax_element(
      rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  throw ConfigError(fmt::format("world '{}' has no row {}, its rows are {} to {}", world.name, row,
                                least->id, most->id));
}

}  // namespace

HiddenRows::HiddenRows(const WorldModel& world, const std::vector<int>& hidden) {
  for (const int row : hidden) check_row(world, row);
  if (hidden.empty()) return;
  for (const PlantRow& row : world.rows->rows) {
    std::vector<Eigen::Vector2d> points;
    for (const Eigen::Vector3d& p : row.line_W) points.push_back(p.head<2>());
    lines_.emplace_back(std::move(points));
    hidden_.push_back(std::find(hidden.begin(), hidden.end(), row.id) != hidden.end());
  }
}

bool HiddenRows::hide(const Eigen::Vector3d& p_W, PointClass truth) const {
  if (truth != PointClass::kCanopy) return false;
  double nearest_m = std::numeric_limits<double>::infinity();
  bool hides = false;
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    double here_m = 0.0;
    lines_[k].nearest_s_m(p_W.head<2>(), &here_m);
    if (here_m < nearest_m) nearest_m = here_m, hides = hidden_[k];
  }
  return hides;
}

}  // namespace vinerow::mapping
