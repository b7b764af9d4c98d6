#pragma once
/// Worlds that several benchmarks share.

#include <cmath>
#include <memory>

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
    const std::string& type, const std::vector<std::pair<std::string, ParameterSet::Value>>& values = {}) {
  Registry registry;
  register_all(registry);
  ParameterSet parameters(registry.spec(PartKind::kWorld, type).parameters, type);
  for (const auto& [name, value] : values) parameters.set(name, value);
  return registry.make_world(type, parameters, WorldContext{});
}

}  // namespace vinerow::bench
