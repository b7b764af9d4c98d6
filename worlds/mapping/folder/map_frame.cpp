#include "worlds/mapping/folder/map_frame.h"

#include <Eigen/Geometry>
#include <cmath>

#include "engine/core/check.h"
#include "engine/math/geo.h"
#include "worlds/mapping/model/map_placement.h"

namespace vinerow::mapping {
namespace {

/// Frame of the new W in which points of the old are given: both are straight axes in space.
Eigen::Isometry3d find_move(const GeoOrigin& from, const GeoOrigin& to) {
  const LocalFrame old_frame(from), new_frame(to);
  const auto moved = [&](const Eigen::Vector3d& p) {
    return new_frame.to_local(old_frame.to_geodetic(p));
  };
  // Far arms: what rounding there is in latitudes turns the axes by less than 1e-12.
  constexpr double kArm_m = 1e4;
  const Eigen::Vector3d origin = moved(Eigen::Vector3d::Zero());
  const Eigen::Vector3d x = (moved({kArm_m, 0, 0}) - origin).normalized();
  const Eigen::Vector3d z = x.cross(moved({0, kArm_m, 0}) - origin).normalized();
  Eigen::Isometry3d move = Eigen::Isometry3d::Identity();
  move.linear().col(0) = x;
  move.linear().col(1) = z.cross(x);
  move.linear().col(2) = z;
  move.translation() = origin;
  return move;
}

HeightField move_terrain(const Eigen::Isometry3d& move, const HeightField& old) {
  const Eigen::Isometry3d back = move.inverse();
  HeightField field = old;
  const Eigen::Vector2d middle = old.corner_W + 0.5 * Eigen::Vector2d(old.width_m(), old.depth_m());
  const Eigen::Vector3d middle_W(middle.x(), middle.y(), old.height_m(middle.x(), middle.y()));
  field.corner_W += (move * middle_W - middle_W).head<2>();
  std::size_t at = 0;
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i, ++at) {
      const Eigen::Vector2d p = field.corner_W + field.cell_m * Eigen::Vector2d(i, j);
      // The frames' tilt is small: after two steps the place no longer moves.
      double z = (move * middle_W).z();
      for (int step = 0; step < 3; ++step) {
        const Eigen::Vector3d there = back * Eigen::Vector3d(p.x(), p.y(), z);
        z = (move * Eigen::Vector3d(there.x(), there.y(), old.height_m(there.x(), there.y()))).z();
      }
      field.heights_m[at] = static_cast<float>(z);
    }
  }
  return field;
}

void move_grid(const Eigen::Isometry3d& move, const Eigen::Vector3d& middle_W,
               OccupancyGrid& grid) {
  MapPlacement placement;
  placement.middle_W = middle_W;
  placement.shift_m = move * middle_W - middle_W;
  const double turn_rad = std::atan2(move.linear()(1, 0), move.linear()(0, 0));
  const double reach_m = 0.5 * grid.cell_m * std::hypot(grid.columns, grid.rows);
  if (std::abs(turn_rad) * reach_m > 0.25 * grid.cell_m) placement.turn_rad = turn_rad;
  RowMap only;
  only.occupancy = std::move(grid);
  place_rows(placement, only);
  grid = std::move(only.occupancy);
}

Eigen::AlignedBox2d box_of(const std::vector<PlantRow>& rows) {
  Eigen::AlignedBox2d box;
  for (const PlantRow& row : rows) {
    for (const Eigen::Vector3d& p : row.line_W) box.extend(Eigen::Vector2d(p.head<2>()));
  }
  return box;
}

}  // namespace

void move_map(const GeoOrigin& to, CloudMap& map) {
  VINEROW_DEMAND(map.has_origin);
  if (map.origin.latitude_rad == to.latitude_rad && map.origin.longitude_rad == to.longitude_rad &&
      map.origin.altitude_m == to.altitude_m) {
    return;
  }
  const Eigen::Isometry3d move = find_move(map.origin, to);
  RowMap& m = map.map;
  // The grid is as high as the rows; its middle is what shifts least where the frames are tilted.
  if (!m.occupancy.empty()) {
    const Eigen::Vector2d middle =
        m.occupancy.corner_W +
        0.5 * m.occupancy.cell_m * Eigen::Vector2d(m.occupancy.columns, m.occupancy.rows);
    move_grid(move, {middle.x(), middle.y(), middle_of(m.rows).z()}, m.occupancy);
  }
  const double ground_m = middle_of(m.rows).z();
  if (m.terrain) m.terrain = move_terrain(move, *m.terrain);
  for (PlantRow& row : m.rows) {
    for (Eigen::Vector3d& p : row.line_W) p = move * p;
  }
  for (Alley& alley : m.alleys) {
    for (Eigen::Vector3d& p : alley.line_W) p = move * p;
  }
  for (Eigen::Vector2d& p : m.boundary_W) {
    p = (move * Eigen::Vector3d(p.x(), p.y(), ground_m)).head<2>();
  }
  for (RowMesh& mesh : m.meshes) {
    for (Eigen::Vector3f& v : mesh.mesh_W.vertices) {
      v = (move * v.cast<double>()).cast<float>();
    }
  }
  for (MappedRowFigures& row : map.report.rows) {
    row.first_W = move * row.first_W;
    row.last_W = move * row.last_W;
  }
  map.origin = to;
}

double distance_between_m(const std::vector<PlantRow>& a, const std::vector<PlantRow>& b) {
  const Eigen::AlignedBox2d one = box_of(a), other = box_of(b);
  return one.intersects(other) ? 0.0 : one.exteriorDistance(other);
}

}  // namespace vinerow::mapping
