#include "controllers/planning/routes/mission_kinds.h"

#include <algorithm>
#include <cmath>

#include "engine/api/messages/path.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

void set_mission_kinds(const std::vector<bool>& camera, bool uses_camera, PlannedPath& path) {
  std::vector<PathPoint>& points = path.points;
  const std::size_t n = points.size(), end = n - 1;
  std::size_t first = n, last = 0;
  for (std::size_t i = 0; i < end; ++i) {
    if (points[i].kind != PathKind::kLeg) continue;
    if (uses_camera && !camera[i]) {
      points[i].kind = PathKind::kTurn;
      continue;
    }
    first = std::min(first, i);
    last = i;
  }
  constexpr double kSame_m = 1e-3, kBend_rad = 0.5;
  int alley = -1;
  for (std::size_t i = 0; i < n; ++i) {
    PathPoint& point = points[i];
    const std::size_t from = i < end ? i : end - 1;
    const Eigen::Vector2d displacement = (points[from + 1].p_W - points[from].p_W).head<2>();
    const double before_rad = i > 0 ? points[i - 1].yaw_rad : 0.0;
    point.yaw_rad =
        displacement.norm() < kSame_m ? before_rad : std::atan2(displacement.y(), displacement.x());
    if (point.kind == PathKind::kTurn && (i < first || i > last)) {
      point.kind = i < first ? PathKind::kTransit : PathKind::kReturn;
    }
    if (point.kind != PathKind::kLeg || i == end) continue;
    const bool goes_on = i > 0 && points[i - 1].kind == PathKind::kLeg &&
                         std::abs(wrap_angle(point.yaw_rad - before_rad)) < kBend_rad;
    point.alley = goes_on ? alley : ++alley;
  }
  if (points[end].kind != PathKind::kVertical) {
    points[end].kind = points[end - 1].kind;
    points[end].alley = points[end - 1].alley;
  }
}

}  // namespace vinerow::controllers
