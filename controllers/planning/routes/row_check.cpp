#include "controllers/planning/routes/row_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "controllers/parts/paths/pose2.h"
#include "engine/api/map.h"
#include "engine/api/messages/path.h"
#include "engine/math/polyline.h"

namespace vinerow::controllers {
namespace {

using Vec = Eigen::Vector2d;

double distance_between_segments(const Vec& a, const Vec& b, const Vec& c, const Vec& d) {
  const Vec ab = b - a, cd = d - c;
  const bool crosses =
      cross(ab, c - a) * cross(ab, d - a) < 0.0 && cross(cd, a - c) * cross(cd, b - c) < 0.0;
  if (crosses) return 0.0;
  return std::min({distance_to_segment_m<2>(a, c, d), distance_to_segment_m<2>(b, c, d),
                   distance_to_segment_m<2>(c, a, b), distance_to_segment_m<2>(d, a, b)});
}

std::string describe(const PathPoint& point) {
  if (point.kind == PathKind::kLeg && point.alley >= 0) {
    return fmt::format("the leg in alley {}", point.alley);
  }
  return point.kind == PathKind::kTurn ? "the turn" : "the path";
}

}  // namespace

std::optional<std::string> find_path_into_row(const PlannedPath& path, const RowMap& map,
                                              double clearance_m) {
  for (const PlantRow& row : map.rows) {
    const double reach = 0.5 * row.canopy_width_m + clearance_m;
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& p : row.line_W) box.extend(Vec(p.head<2>()));
    for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
      const Vec from = path.points[i].p_W.head<2>(), to = path.points[i + 1].p_W.head<2>();
      Eigen::AlignedBox2d stretch(from.cwiseMin(to), from.cwiseMax(to));
      if (box.squaredExteriorDistance(stretch) >= reach * reach) continue;
      for (std::size_t j = 0; j + 1 < row.line_W.size(); ++j) {
        const double distance = distance_between_segments(from, to, row.line_W[j].head<2>(),
                                                          row.line_W[j + 1].head<2>());
        if (distance >= reach) continue;
        return fmt::format(
            "path into a row: {} passes ({:.2f}, {:.2f}), {:.2f} m from the centre line of row {}, "
            "whose canopy is {:.2f} m wide{}",
            describe(path.points[i]), from.x(), from.y(), distance, row.id, row.canopy_width_m,
            clearance_m > 0.0 ? fmt::format(" and needs a clearance of {:.2f} m", clearance_m)
                              : "");
      }
    }
  }
  return std::nullopt;
}

}  // namespace vinerow::controllers
