#include "worlds/parts/alley_spawns.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/api/map.h"
#include "engine/api/world_model.h"

namespace vinerow::worlds {

void add_alley_spawn_points(WorldModel& world) {
  for (const Alley& alley : world.rows->alleys) {
    const auto& line = alley.line_W;
    const auto add = [&](const char* end, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      const Eigen::Vector2d d = (to - from).head<2>();
      world.spawn_points.push_back(
          {fmt::format("alley_{}_{}", alley.id, end), from.head<2>(), std::atan2(d.y(), d.x())});
    };
    add("start", line.front(), line[1]);
    add("end", line.back(), line[line.size() - 2]);
  }
}

}  // namespace vinerow::worlds
