#include "controllers/parts/paths/lift.h"

#include <fmt/format.h>

#include "engine/api/messages/path.h"

namespace vinerow::controllers {

std::optional<std::string> lift_to_ground(const SceneQuery* scene, double height_m,
                                          PlannedPath& path) {
  const PathPoint* bare = nullptr;
  bool has_ground = false;
  for (PathPoint& point : path.points) {
    point.p_W.z() = height_m;
    if (scene == nullptr) continue;
    const auto ground = scene->ground_height_m(point.p_W.x(), point.p_W.y(), kAboveEverything_m);
    if (ground) {
      point.p_W.z() = *ground;
      has_ground = true;
    } else if (bare == nullptr) {
      bare = &point;
    }
  }
  if (!has_ground || bare == nullptr) return std::nullopt;
  return fmt::format("path leaves the ground: no ground at ({:.2f}, {:.2f})", bare->p_W.x(),
                     bare->p_W.y());
}

}  // namespace vinerow::controllers
