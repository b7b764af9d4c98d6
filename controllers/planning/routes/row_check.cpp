#include "controllers/planning/routes/row_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/pose2.h"
#include "engine/api/map.h"
#include "engine/api/messages/path.h"
#include "engine/api/vehicle.h"
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

/// A stretch of a path that comes too near to a row.
struct Approach {
  std::size_t point = 0;  ///< at which it begins
  const PlantRow* row = nullptr;
  double distance_m = 0.0;
};

/// First stretch that is nearer to the centre line of a row than its reach.
template <class Reach>
std::optional<Approach> find_approach(const PlannedPath& path, const RowMap& map, Reach&& reach_m) {
  for (const PlantRow& row : map.rows) {
    const double reach = reach_m(row);
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& p : row.line_W) box.extend(Vec(p.head<2>()));
    for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
      const Vec from = path.points[i].p_W.head<2>(), to = path.points[i + 1].p_W.head<2>();
      Eigen::AlignedBox2d stretch(from.cwiseMin(to), from.cwiseMax(to));
      if (box.squaredExteriorDistance(stretch) >= reach * reach) continue;
      for (std::size_t j = 0; j + 1 < row.line_W.size(); ++j) {
        const double distance = distance_between_segments(from, to, row.line_W[j].head<2>(),
                                                          row.line_W[j + 1].head<2>());
        if (distance < reach) return Approach{i, &row, distance};
      }
    }
  }
  return std::nullopt;
}

std::string describe(const PlannedPath& path, const Approach& approach) {
  const PathPoint& point = path.points[approach.point];
  std::string what = point.kind == PathKind::kTurn ? "the turn" : "the path";
  if (point.kind == PathKind::kLeg && point.alley >= 0) {
    what = fmt::format("the leg in alley {}", point.alley);
  }
  return fmt::format(
      "path into a row: {} passes ({:.2f}, {:.2f}), {:.2f} m from the centre line of row {}", what,
      point.p_W.x(), point.p_W.y(), approach.distance_m, approach.row->id);
}

}  // namespace

double find_half_width_m(const VehicleDescription& vehicle) {
  double half_m = 0.0;
  if (vehicle.flies()) return half_m;
  for (const Vec& p : vehicle.outline_B()) half_m = std::max(half_m, std::abs(p.y()));
  return half_m;
}

std::optional<std::string> find_path_into_row(const PlannedPath& path, const RowMap& map,
                                              double clearance_m, double half_width_m) {
  const auto canopy = find_approach(
      path, map, [&](const PlantRow& row) { return 0.5 * row.canopy_width_m + clearance_m; });
  if (canopy) {
    return fmt::format(
        "{}, whose canopy is {:.2f} m wide{}", describe(path, *canopy), canopy->row->canopy_width_m,
        clearance_m > 0.0 ? fmt::format(" and needs a clearance of {:.2f} m", clearance_m) : "");
  }
  const auto post = find_approach(path, map, [&](const PlantRow&) { return half_width_m; });
  if (!post) return std::nullopt;
  return fmt::format("{}, and the vehicle is {:.2f} m wide", describe(path, *post),
                     2.0 * half_width_m);
}

}  // namespace vinerow::controllers
