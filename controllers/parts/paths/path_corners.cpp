#include "controllers/parts/paths/path_corners.h"

#include <cmath>

#include "engine/api/messages/path.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

std::vector<PathCorner> find_corners(const PlannedPath& plan, double min_rad) {
  constexpr double kSamePlace_m = 1e-6;
  std::vector<PathCorner> corners;
  double arrival_rad = 0.0;
  bool has_arrival = false;
  for (std::size_t i = 0; i + 1 < plan.points.size(); ++i) {
    const PathPoint& from = plan.points[i];
    const Eigen::Vector2d chord = (plan.points[i + 1].p_W - from.p_W).head<2>();
    if (chord.norm() < kSamePlace_m) continue;
    const double chord_rad = std::atan2(chord.y(), chord.x());
    const bool is_bent = from.curvature_per_m != 0.0;
    const double turn_rad =
        has_arrival ? wrap_angle((is_bent ? from.yaw_rad : chord_rad) - arrival_rad) : 0.0;
    if (std::abs(turn_rad) > min_rad) corners.push_back({static_cast<int>(i), turn_rad});
    arrival_rad = is_bent ? 2.0 * chord_rad - from.yaw_rad : chord_rad;
    has_arrival = true;
  }
  return corners;
}

}  // namespace vinerow::controllers
