#include "controllers/planning/routes/row_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/pose2.h"
#include "engine/api/map.h"
#include "engine/api/messages/path.h"
#include "engine/api/vehicle.h"
#include "engine/math/polygon.h"
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

Eigen::AlignedBox2d box_of(const PlantRow& row) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& p : row.line_W) box.extend(Vec(p.head<2>()));
  return box;
}

/// A stretch of a path that comes too near to a row.
struct Approach {
  std::size_t point = 0;  ///< at which it begins
  const PlantRow* row = nullptr;
  double distance_m = 0.0;
};

/// First stretch that is nearer to a canopy than the clearance.
std::optional<Approach> find_approach(const PlannedPath& path, const RowMap& map,
                                      double clearance_m) {
  for (const PlantRow& row : map.rows) {
    const double reach = 0.5 * row.canopy_width_m + clearance_m;
    const Eigen::AlignedBox2d box = box_of(row);
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

/// Whether a segment has a point inside a convex, counter-clockwise polygon.
bool meets(const Polygon& outline, const Vec& a, const Vec& b) {
  const Vec inside = clip_line(outline, a, b - a);
  return std::max(inside[0], 0.0) < std::min(inside[1], 1.0);
}

/// First stretch along which the outline of the vehicle, in the direction of travel, lies on the
/// centre line of a row.
std::optional<Approach> find_outline_on_row(const PlannedPath& path, const RowMap& map,
                                            const Polygon& outline_B) {
  constexpr double kStep_m = 0.1;  // finer than a post is thick
  double reach_m = 0.0;
  for (const Vec& corner : outline_B) reach_m = std::max(reach_m, corner.norm());
  for (const PlantRow& row : map.rows) {
    const Eigen::AlignedBox2d box = box_of(row);
    for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
      const Vec from = path.points[i].p_W.head<2>(), to = path.points[i + 1].p_W.head<2>();
      const double length_m = (to - from).norm();
      Eigen::AlignedBox2d stretch(from.cwiseMin(to), from.cwiseMax(to));
      if (length_m <= 0.0 || box.squaredExteriorDistance(stretch) >= reach_m * reach_m) continue;
      const Eigen::Rotation2Dd R_BW(-std::atan2(to.y() - from.y(), to.x() - from.x()));
      const int steps = static_cast<int>(std::ceil(length_m / kStep_m));
      for (int k = 0; k <= steps; ++k) {
        const Vec p_W = from + (to - from) * k / steps;
        for (std::size_t j = 0; j + 1 < row.line_W.size(); ++j) {
          const Vec a = R_BW * (row.line_W[j].head<2>() - p_W);
          const Vec b = R_BW * (row.line_W[j + 1].head<2>() - p_W);
          if (meets(outline_B, a, b)) return Approach{i, &row, 0.0};
        }
      }
    }
  }
  return std::nullopt;
}

std::string describe(const PlannedPath& path, std::size_t at) {
  const PathPoint& point = path.points[at];
  std::string what = point.kind == PathKind::kTurn ? "the turn" : "the path";
  if (point.kind == PathKind::kLeg && point.alley >= 0) {
    what = fmt::format("the leg in alley {}", point.alley);
  }
  return fmt::format("path into a row: {} passes ({:.2f}, {:.2f})", what, point.p_W.x(),
                     point.p_W.y());
}

}  // namespace

std::optional<std::string> find_path_into_row(const PlannedPath& path, const RowMap& map,
                                              double clearance_m,
                                              const VehicleDescription* vehicle) {
  const auto canopy = find_approach(path, map, clearance_m);
  if (canopy) {
    return fmt::format(
        "{}, {:.2f} m from the centre line of row {}, whose canopy is {:.2f} m wide{}",
        describe(path, canopy->point), canopy->distance_m, canopy->row->id,
        canopy->row->canopy_width_m,
        clearance_m > 0.0 ? fmt::format(" and needs a clearance of {:.2f} m", clearance_m) : "");
  }
  if (vehicle == nullptr || vehicle->flies()) return std::nullopt;
  const auto outline = find_outline_on_row(path, map, vehicle->outline_B());
  if (!outline) return std::nullopt;
  return fmt::format("{}, where the vehicle's outline touches row {}",
                     describe(path, outline->point), outline->row->id);
}

}  // namespace vinerow::controllers
