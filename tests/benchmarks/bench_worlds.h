#pragma once
/// Worlds that several benchmarks share.

#include <cmath>
#include <memory>

#include "engine/api/map.h"
#include "engine/api/registry.h"
#include "engine/api/world_model.h"
#include "tools/parts/register_all.h"

namespace vinerow::bench {

/// 200 x 200 samples, 0.5 m apart, gentle waves.
inline WorldModel rolling_field() {
  WorldModel world;
  HeightField field;
  field.columns = field.rows = 200;
  field.cell_m = 0.5;
  field.corner_W = {-50.0, -50.0};
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      field.heights_m.push_back(static_cast<float>(0.3 * std::sin(0.11 * i) * std::cos(0.07 * j)));
    }
  }
  world.terrain = field;
  return world;
}

/// A built-in world with its defaults and what is set over them.
inline std::unique_ptr<WorldModel> make_world(
    const std::string& type,
    const std::vector<std::pair<std::string, ParameterSet::Value>>& values = {}) {
  Registry registry;
  register_all(registry);
  ParameterSet parameters(registry.spec(PartKind::kWorld, type).parameters, type);
  for (const auto& [name, value] : values) parameters.set(name, value);
  return registry.make_world(type, parameters, WorldContext{});
}

/// Four rows of 40 m in full leaf, whose leaves are there one by one.
inline std::shared_ptr<const WorldModel> vineyard_in_leaf() {
  Registry registry;
  register_all(registry);
  ParameterSet parameters(registry.spec(PartKind::kWorld, "vineyard").parameters, "vineyard");
  parameters.set("row_count", std::int64_t{4}).set("row_length_m", 40.0);
  ParameterSet vines = parameters.make_group("vines");
  vines.set("bbch", 79.0);
  parameters.set("vines", std::vector<ParameterSet>{vines});
  return registry.make_world("vineyard", parameters, WorldContext{});
}

/// 1 m above the middle of its second alley, a fifth of the way along it, x along it.
inline Pose place_in_alley(const WorldModel& world) {
  const std::vector<Eigen::Vector3d>& line = world.rows->alleys[1].line_W;
  const Eigen::Vector3d along = (line.back() - line.front()).normalized();
  Pose X_WB;
  X_WB.p = line.front() + 0.2 * (line.back() - line.front()) + Eigen::Vector3d::UnitZ();
  X_WB.q = Eigen::AngleAxisd(std::atan2(along.y(), along.x()), Eigen::Vector3d::UnitZ());
  return X_WB;
}

}  // namespace vinerow::bench
