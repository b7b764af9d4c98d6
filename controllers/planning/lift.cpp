#include "controllers/planning/lift.h"

namespace vinerow {

void lift_to_ground(const SceneQuery* scene, double height_m, PlannedPath& path) {
  constexpr double kAboveEverything_m = 1e4;  // higher than any ground within a scenario
  for (PathPoint& point : path.points) {
    if (scene != nullptr) {
      const auto ground = scene->ground_height_m(point.p_W.x(), point.p_W.y(), kAboveEverything_m);
      if (ground) height_m = *ground;
    }
    point.p_W.z() = height_m;
  }
}

}  // namespace vinerow
